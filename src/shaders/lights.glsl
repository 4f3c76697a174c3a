// Next-event estimation: one light drawn by power, one point on it; and the density of that for a ray that found a
// light by itself (multiple importance sampling). Punctual lights: KHR_lights_punctual.
#ifndef LIMPID_LIGHTS_GLSL
#define LIMPID_LIGHTS_GLSL

#include "shaders/environment.glsl"
#include "shaders/material.glsl"
#include "shaders/trace.glsl"

struct LightSample {
    vec3 direction;
    float distance;  // INFINITE_DISTANCE: no target, only a direction
    vec3 target;     // just before the light: where the shadow ray ends
    vec3 radiance;   // incident, for punctual lights divided by nothing: weight = radiance / pdf
    float pdf;       // per solid angle; for punctual lights the probability of choosing the light
    bool delta;      // only this technique finds the light
};

/// KHR_lights_punctual's cone and range attenuation over squared distance.
float punctualAttenuation(uint kind, vec3 direction, vec3 axis, float distance, vec3 shape) {
    if (kind == LIGHT_DIRECTIONAL) return 1.0;
    float attenuation = 1.0 / max(distance * distance, 1e-20);
    if (shape.z > 0.0) {
        const float ratio = distance / shape.z;
        const float r2 = ratio * ratio;
        attenuation *= clamp(1.0 - r2 * r2, 0.0, 1.0);
    }
    if (kind == LIGHT_SPOT) {
        const float scale = 1.0 / max(0.001, shape.x - shape.y);
        const float cone = clamp((dot(axis, -direction) - shape.y) * scale, 0.0, 1.0);
        attenuation *= cone * cone;
    }
    return attenuation;
}

/// Barycentrics are of the mesh, not of the light; `cosine` is of the direction in which the light leaves.
vec3 lightEmission(uvec4 record3, uint shadingTriangle, vec2 barycentrics, float cosine) {
    vec3 emission = uintBitsToFloat(record3.xyz);
    if (HAS_TEXTURES || HAS_CLEARCOAT) {
        if (record3.w != NONE) {
            const int material = int(record3.w * MATERIAL_TEXELS);
            float coat = HAS_CLEARCOAT ? uintBitsToFloat(imageLoad(materials, material + 7).y) : 0.0;
            if (HAS_TEXTURES) {
                const VertexData data = loadVertexData(imageLoad(triangles, int(shadingTriangle)).xyz, barycentrics);
                emission *= materialTexture(imageLoad(materials, material + 4).w, data, 0.0).rgb;
                if (HAS_CLEARCOAT) coat *= materialTexture(imageLoad(materials, material + 6).z, data, 0.0).r;
            }
            if (HAS_CLEARCOAT) emission *= emissionThroughClearcoat(coat, cosine);
        }
    }
    return emission;
}

LightSample sampleTriangleLight(uvec4 r0, uvec4 r1, uvec4 r2, uvec4 r3, vec3 from, vec2 u) {
    const vec3 v0 = uintBitsToFloat(r0.xyz), v1 = uintBitsToFloat(r1.xyz), v2 = uintBitsToFloat(r2.xyz);
    const vec2 barycentrics = sampleTriangle(u);
    const vec3 perpendicular = cross(v1 - v0, v2 - v0);
    const float doubleArea = length(perpendicular);
    const vec3 point = interpolate(v0, v1, v2, barycentrics);
    const vec3 toLight = point - from;
    const float distance2 = dot(toLight, toLight);
    vec3 normal = perpendicular / max(doubleArea, 1e-37);
    float cosine = -dot(normal, toLight) * inversesqrt(max(distance2, 1e-37));
    if ((r0.w & LIGHT_KIND_MASK) == LIGHT_TRIANGLE_TWO_SIDED && cosine < 0.0) {
        cosine = -cosine;
        normal = -normal;
    }
    LightSample light;
    light.target = offsetRay(point, normal, max(maxAbs(v0), max(maxAbs(v1), maxAbs(v2))));
    light.distance = sqrt(distance2);
    light.direction = toLight / max(light.distance, 1e-37);
    const bool visible = cosine > 0.0 && doubleArea > 0.0;
    light.pdf = visible ? uintBitsToFloat(r1.w) * 2.0 * distance2 / (doubleArea * cosine) : 0.0;
    const vec2 order = (r0.w & LIGHT_MIRRORED) != 0u ? barycentrics.yx : barycentrics;
    light.radiance = visible ? lightEmission(r3, r2.w, order, cosine) : vec3(0.0);
    light.delta = false;
    return light;
}

LightSample samplePunctualLight(uvec4 r0, uvec4 r1, uvec4 r2, uvec4 r3, vec3 from, SceneParams scene) {
    const uint kind = r0.w & LIGHT_KIND_MASK;
    const vec3 axis = uintBitsToFloat(r1.xyz);
    LightSample light;
    light.target = uintBitsToFloat(r0.xyz);
    if (kind == LIGHT_DIRECTIONAL) {
        light.direction = -axis;
        light.distance = INFINITE_DISTANCE;
    } else {
        const vec3 toLight = uintBitsToFloat(r0.xyz) - from;
        light.distance = length(toLight);
        light.direction = toLight / max(light.distance, 1e-37);
    }
    light.radiance = uintBitsToFloat(r3.xyz) *
                     punctualAttenuation(kind, light.direction, axis, light.distance, uintBitsToFloat(r2.xyz));
    light.pdf = uintBitsToFloat(r1.w);
    light.delta = true;
    return light;
}

/// The ray that must be free for the light to count. It runs from start to target, both moved off their surfaces: along
/// the unmoved direction the two offsets could cancel and let the light shadow itself.
Ray shadowRay(vec3 start, LightSample light) {
    if (light.distance == INFINITE_DISTANCE) return Ray(start, light.direction, INFINITE_DISTANCE);
    const vec3 path = light.target - start;
    const float distance = length(path);
    return Ray(start, path / max(distance, 1e-37), distance);
}

/// A light as seen from `from`; pdf 0: nothing to be had there.
LightSample sampleLight(vec3 from, SceneParams scene, inout uint rng) {
    const float choice = random(rng), decision = random(rng);
    const vec2 u = random2(rng);
    LightSample light = LightSample(vec3(0.0), 0.0, vec3(0.0), vec3(0.0), 0.0, false);
    const float environmentShare = HAS_ENVIRONMENT ? scene.environmentProbability : 0.0;
    if (HAS_ENVIRONMENT) {
        if (choice < environmentShare) {
            const EnvironmentSample s = sampleEnvironment(vec2(choice / environmentShare, decision), u, scene);
            light = LightSample(s.direction, INFINITE_DISTANCE, vec3(0.0), s.radiance, s.pdf * environmentShare, false);
        }
    }
    if (HAS_TRIANGLE_LIGHTS || HAS_PUNCTUAL_LIGHTS) {
        if (choice >= environmentShare && scene.lightCount > 0u) {
            const float rescaled = (choice - environmentShare) / max(1.0 - environmentShare, 1e-20);
            uint index = min(uint(rescaled * float(scene.lightCount)), scene.lightCount - 1u);
            const uvec2 entry = imageLoad(lightAlias, int(index)).xy;
            index = decision < uintBitsToFloat(entry.x) ? index : entry.y;
            const int at = int(index * LIGHT_TEXELS);
            const uvec4 r0 = imageLoad(lights, at), r1 = imageLoad(lights, at + 1);
            const uvec4 r2 = imageLoad(lights, at + 2), r3 = imageLoad(lights, at + 3);
            const bool punctual = (r0.w & LIGHT_KIND_MASK) >= LIGHT_POINT;
            if (HAS_TRIANGLE_LIGHTS && !(HAS_PUNCTUAL_LIGHTS && punctual)) {
                light = sampleTriangleLight(r0, r1, r2, r3, from, u);
            } else if (HAS_PUNCTUAL_LIGHTS) {
                light = samplePunctualLight(r0, r1, r2, r3, from, scene);
            }
            light.pdf *= 1.0 - environmentShare;
        }
    }
    return light;
}

/// Density per solid angle with which sampleLight draws the point where a ray of length `distance` met the surface.
float lightPdf(Surface s, float distance, vec3 direction, SceneParams scene) {
    const uint first = imageLoad(instances, int(s.instance * INSTANCE_TEXELS) + 3).y;
    if (first == NONE) return 0.0;
    const float perArea = imageLoad(lightDensity, int(first + s.primitive)).x;
    const float cosine = abs(dot(s.geometricNormal, direction));
    const float share = HAS_ENVIRONMENT ? 1.0 - scene.environmentProbability : 1.0;
    return cosine > 0.0 ? share * perArea * distance * distance / cosine : 0.0;
}

#endif
