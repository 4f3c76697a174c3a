#version 460
#extension GL_EXT_scalar_block_layout : require
#include "shaders/common/filter_image.glsl"
#define OUTPUT_FORMAT rgba16f
#define OUTPUT_VALUE(color) nearestHalf(clamp(color, vec4(-MAX_HALF), vec4(MAX_HALF)))
#include "denoise/stages/output/output.glsl"
