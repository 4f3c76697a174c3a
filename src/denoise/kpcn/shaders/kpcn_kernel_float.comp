#version 460
#extension GL_EXT_scalar_block_layout : require
// kpcn_kernel.glsl in single precision.
#define KPCN_FLOAT
#include "denoise/kpcn/shaders/kpcn_kernel.glsl"
