#version 460
#extension GL_EXT_scalar_block_layout : require
// atrous_level.glsl with gpu::Backing::Image.
#include "denoise/atrous/atrous_level.glsl"
