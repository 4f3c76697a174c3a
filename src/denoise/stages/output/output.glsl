// Writes a denoiser's picture to an image of the caller. The including shader defines its format as OUTPUT_FORMAT.
layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    uvec2 extent;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D picture;
layout(set = 0, binding = 2, OUTPUT_FORMAT) uniform writeonly image2D result;

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= extent.x || pixel.y >= extent.y) return;
    const ivec2 at = ivec2(pixel);
    imageStore(result, at, OUTPUT_VALUE(imageLoad(picture, at)));
}
