// The latitude-longitude environment: bilinear look-up, and importance sampling by texel (pbrt 4th ed., section 12.5,
// with the warp of scene/device/tables/weight_pyramid.h).
#ifndef LIMPID_ENVIRONMENT_GLSL
#define LIMPID_ENVIRONMENT_GLSL

#include "shaders/common/sampling.glsl"
#include "shaders/common/scene_data.glsl"

struct EnvironmentSample {
    vec3 direction;
    vec3 radiance;
    float pdf;  // per solid angle
};

/// Converts the coordinates of a direction (latLongOf) to those of the picture.
vec2 turnedUv(vec2 uv, SceneParams scene) {
    return vec2(fract(uv.x - scene.environmentTurn), uv.y);
}

/// `uv` is in the picture's coordinates.
vec3 texelRadiance(vec2 uv, SceneParams scene) {
    const ivec2 size = ivec2(scene.environmentWidth, scene.environmentHeight);
    const vec2 p = uv * vec2(size) - 0.5;
    const ivec2 base = ivec2(floor(p));
    const vec2 f = p - vec2(base);
    const int x0 = (base.x + size.x) % size.x, x1 = (base.x + 1) % size.x;
    const int row0 = clamp(base.y, 0, size.y - 1) * size.x, row1 = clamp(base.y + 1, 0, size.y - 1) * size.x;
    return scene.environmentScale *
           mix(mix(imageLoad(environment, row0 + x0).rgb, imageLoad(environment, row0 + x1).rgb, f.x),
               mix(imageLoad(environment, row1 + x0).rgb, imageLoad(environment, row1 + x1).rgb, f.x), f.y);
}

/// `uv` is that of a direction.
vec3 environmentRadiance(vec2 uv, SceneParams scene) {
    return texelRadiance(turnedUv(uv, scene), scene);
}

/// Converts a texel's probability to a density per solid angle.
float environmentDensity(float probability, float v, SceneParams scene) {
    const float texels = float(scene.environmentWidth) * float(scene.environmentHeight);
    return probability * texels / (2.0 * PI * PI * max(sin(v * PI), 1e-6));
}

/// `uv` is that of a direction.
float environmentPdf(vec2 uv, SceneParams scene) {
    uv = turnedUv(uv, scene);
    const uvec2 size = uvec2(scene.environmentWidth, scene.environmentHeight);
    const uvec2 texel = min(uvec2(uv * vec2(size)), size - 1u);
    const float probability = imageLoad(environment, int(texel.y * size.x + texel.x)).w;
    return environmentDensity(probability, uv.y, scene);
}

/// Warps `u`, of the unit square, to the picture's coordinates in proportion to the texels' probabilities: from the
/// whole picture to a quarter of it, and on to a texel. `texel` is its index.
vec2 warpedToTexels(vec2 u, uvec2 size, out uint texel) {
    uvec2 at = uvec2(0u);
    uint first = 0u;
    for (int level = findMSB(max(size.x, size.y) * 2u - 1u); level > 0; --level) {
        const uvec2 count = (size + (1u << level) - 1u) >> level;
        const vec4 quarters = imageLoad(environmentPyramid, int(first + at.y * count.x + at.x));
        first += count.x * count.y;
        const uint column = takePart(quarters.x + quarters.z, quarters.y + quarters.w, u.x);
        const vec2 rows = column == 0u ? quarters.xz : quarters.yw;
        at = 2u * at + uvec2(column, takePart(rows.x, rows.y, u.y));
    }
    texel = at.y * size.x + at.x;
    return (vec2(at) + u) / vec2(size);
}

/// `u`: a point of the unit square.
EnvironmentSample sampleEnvironment(vec2 u, SceneParams scene) {
    uint texel;
    const vec2 uv = warpedToTexels(u, uvec2(scene.environmentWidth, scene.environmentHeight), texel);
    const float probability = imageLoad(environment, int(texel)).w;
    return EnvironmentSample(directionOfLatLong(vec2(fract(uv.x + scene.environmentTurn), uv.y)), texelRadiance(uv, scene),
                             environmentDensity(probability, uv.y, scene));
}

#endif
