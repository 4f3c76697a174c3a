#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_level.glsl with gpu::Backing::Buffer.
#define LIMPID_FILTER_BUFFERS
#include "denoise/methods/svgf/shaders/svgf_level.glsl"

layout(local_size_x = 64, local_size_y = 2) in;
