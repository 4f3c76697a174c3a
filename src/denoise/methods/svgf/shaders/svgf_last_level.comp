#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_level.glsl for the last level.
#define LIMPID_STABILISES
#include "denoise/methods/svgf/shaders/svgf_level.glsl"
