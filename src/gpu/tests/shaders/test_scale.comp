// result = source * factor + bias, negated on demand: specialisation constants of each type.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = 3) const float factor = 2.0;
layout(constant_id = 5) const int bias = 0;
layout(constant_id = 7) const bool negate = false;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D source;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D result;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(result)))) return;
    const vec4 value = imageLoad(source, pixel) * factor + float(bias);
    imageStore(result, pixel, negate ? -value : value);
}
