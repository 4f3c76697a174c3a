#version 460
#extension GL_EXT_scalar_block_layout : require
#define OUTPUT_FORMAT rgba32f
#define OUTPUT_VALUE(color) (color)
#include "denoise/stages/output/output.glsl"
