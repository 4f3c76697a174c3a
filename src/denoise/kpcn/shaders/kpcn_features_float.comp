#version 460
#extension GL_EXT_scalar_block_layout : require
// kpcn_features.glsl in single precision.
#define KPCN_FLOAT
#include "denoise/kpcn/shaders/kpcn_features.glsl"
