#version 460
// Triangles on top of a picture; positions are in pixels.
layout(push_constant) uniform Push {
    vec2 perPixel;  // 2 / extent
    uvec2 texture;  // extent
} push;

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 texel;
layout(location = 2) in vec4 color;
layout(location = 0) out vec2 outTexel;
layout(location = 1) out vec4 outColor;

void main() {
    outTexel = texel * vec2(push.texture) - 0.5;
    outColor = color;
    gl_Position = vec4(position * push.perPixel - 1.0, 0.0, 1.0);
}
