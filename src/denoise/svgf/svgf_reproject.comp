#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_reproject.glsl with gpu::Backing::Image.
#include "denoise/svgf/svgf_reproject.glsl"
