#version 460
#extension GL_EXT_scalar_block_layout : require
// atrous_modulate.glsl with gpu::Backing::Image.
#include "denoise/methods/atrous/atrous_modulate.glsl"
