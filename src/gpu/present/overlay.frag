#version 460
// The texture is stored in a buffer and interpolated here, since one small texture does not need a sampler.
layout(push_constant) uniform Push {
    vec2 perPixel;
    uvec2 texture;
} push;
layout(set = 0, binding = 0) readonly buffer Texels {
    uint texels[];  // RGBA8
};

layout(location = 0) in vec2 texel;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 result;

vec4 fetch(ivec2 at) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(push.texture) - 1);
    return unpackUnorm4x8(texels[uint(inside.y) * push.texture.x + uint(inside.x)]);
}

void main() {
    const ivec2 at = ivec2(floor(texel));
    const vec2 share = texel - vec2(at);
    const vec4 above = mix(fetch(at), fetch(at + ivec2(1, 0)), share.x);
    const vec4 below = mix(fetch(at + ivec2(0, 1)), fetch(at + ivec2(1, 1)), share.x);
    result = color * mix(above, below, share.y);
}
