#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_level.glsl for all levels but the last.
#include "denoise/methods/svgf/shaders/svgf_level.glsl"
