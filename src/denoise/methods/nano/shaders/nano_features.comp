#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "denoise/methods/nano/shaders/nano_features.glsl"
