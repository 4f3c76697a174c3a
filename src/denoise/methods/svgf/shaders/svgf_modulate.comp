#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_modulate.glsl with gpu::Backing::Image.
#include "denoise/methods/svgf/shaders/svgf_modulate.glsl"
