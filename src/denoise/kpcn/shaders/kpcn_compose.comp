#version 460
#extension GL_EXT_scalar_block_layout : require
// kpcn_compose.glsl with images.
#include "denoise/kpcn/shaders/kpcn_compose.glsl"
