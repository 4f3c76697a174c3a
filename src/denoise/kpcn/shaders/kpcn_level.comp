#version 460
#extension GL_EXT_scalar_block_layout : require
// kpcn_level.glsl with images.
#include "denoise/kpcn/shaders/kpcn_level.glsl"
