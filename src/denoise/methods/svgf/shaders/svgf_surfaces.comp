#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_surfaces.glsl with gpu::Backing::Image.
#include "denoise/methods/svgf/shaders/svgf_surfaces.glsl"
