// Layers of a frame (base/layers/layer_table.h): sampled images, so that they may have any format and may be images of
// the embedding program.
#ifndef LIMPID_LAYER_GLSL
#define LIMPID_LAYER_GLSL
#extension GL_EXT_samplerless_texture_functions : require

#define READ_LAYER(slot, name) layout(set = 0, binding = slot) uniform texture2D name
#define READ_UINT_LAYER(slot, name) layout(set = 0, binding = slot) uniform utexture2D name
#define LOAD_LAYER(name, at) texelFetch(name, at, 0)
// Of a layer that may also have one pixel, which then counts for all.
#define LOAD_WIDE_LAYER(name, at) texelFetch(name, min(at, textureSize(name, 0) - 1), 0)

#endif
