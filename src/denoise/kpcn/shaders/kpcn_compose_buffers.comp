#version 460
#extension GL_EXT_scalar_block_layout : require
// kpcn_compose.glsl with gpu::Backing::Buffer.
#define KPCN_BUFFERS
#include "denoise/kpcn/shaders/kpcn_compose.glsl"
