// Next-event estimation: samples one light and one point on it; and returns the probability density of that
// for a ray that hit a light (multiple importance sampling). Punctual lights: KHR_lights_punctual.
// docs/lighting.md describes the sampling probabilities.
#ifndef LIMPID_LIGHTS_GLSL
#define LIMPID_LIGHTS_GLSL

#include "shaders/material/environment.glsl"
#include "shaders/material/light_tree.glsl"
#include "shaders/material/material.glsl"
#include "shaders/trace/trace.glsl"

/// With both, directional lights and the tree each get at least this share of the samples, since what is brighter may
/// be hidden.
const float MIN_TREE_OR_SUN_SHARE = 0.3;
/// The probability of choosing uniformly among the punctual lights that reach the point, instead of by
/// contribution.
const float PUNCTUAL_UNIFORM_SHARE = 0.4;

Receiver receiverAt(Surface s) {
    const bool coated = HAS_CLEARCOAT && s.clearcoat > 0.0;
    return Receiver(s.position, s.normal, s.geometricNormal, HAS_TRANSMISSION && s.transmission > 0.0, coated ? 0.1 : 0.0);
}

/// The probabilities of sampling the environment, and the emissive triangles or the light tree; the remainder is for
/// punctual lights that are not in the tree.
struct LightShares {
    float environment, triangles;
    Receiver from;  // of which the tree's probabilities depend
};

LightShares noLightShares() {
    return LightShares(0.0, 0.0, Receiver(vec3(0.0), vec3(0.0), vec3(0.0), false, 0.0));
}

struct LightSample {
    vec3 direction;
    float distance;  // INFINITE_DISTANCE: no target, only a direction
    vec3 target;     // just before the light: the end of the shadow ray
    vec3 radiance;   // incident; not divided by the density: weight = radiance / pdf
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

/// Barycentrics are those of the mesh, not of the light; `cosine` is that of the direction in which light
/// leaves.
vec3 lightEmission(uvec4 record3, uint shadingTriangle, vec2 barycentrics, float cosine) {
    vec3 emission = uintBitsToFloat(record3.xyz);
    if (HAS_TEXTURES || HAS_CLEARCOAT || HAS_ALPHA) {
        if (record3.w != NONE) {
            const int material = int(record3.w * MATERIAL_TEXELS);
            const uvec3 indices = imageLoad(triangles, int(shadingTriangle)).xyz;
            float coat = HAS_CLEARCOAT ? uintBitsToFloat(imageLoad(materials, material + 7).y) : 0.0;
            if (HAS_TEXTURES && HAS_VERTEX_DATA) {
                const VertexData data = loadVertexData(indices, barycentrics);
                emission *= materialTexture(imageLoad(materials, material + 4).w, data).rgb;
                if (HAS_CLEARCOAT) coat *= materialTexture(imageLoad(materials, material + 6).z, data).r;
            }
            if (HAS_CLEARCOAT) emission *= emissionThroughClearcoat(coat, cosine);
            // Rays that hit the light meet it by chance.
            bool blended;
            if (HAS_ALPHA) emission *= coverageOf(material, indices, barycentrics, blended);
        }
    }
    return emission;
}

/// The density is that of a point of this triangle.
LightSample sampleTriangleLight(uvec4 r0, uvec4 r1, uvec4 r2, uvec4 r3, vec3 from, vec2 u) {
    const vec3 v0 = uintBitsToFloat(r0.xyz), v1 = uintBitsToFloat(r1.xyz), v2 = uintBitsToFloat(r2.xyz);
    const vec2 barycentrics = sampleTriangle(u);
    const Face face = faceBetween(v1 - v0, v2 - v0);
    const vec3 point = interpolate(v0, v1, v2, barycentrics);
    const vec3 toLight = point - from;
    const float distance2 = dot(toLight, toLight);
    vec3 normal = face.normal;
    float cosine = -dot(normal, toLight) * inversesqrt(max(distance2, 1e-37));
    if ((r0.w & LIGHT_KIND_MASK) == LIGHT_TRIANGLE_TWO_SIDED && cosine < 0.0) {
        cosine = -cosine;
        normal = -normal;
    }
    LightSample light;
    float magnitude = max(maxAbs(v0), max(maxAbs(v1), maxAbs(v2)));
    if (TWO_LEVEL) magnitude = max(magnitude, uintBitsToFloat(r0.w & LIGHT_MAGNITUDE_MASK));
    light.target = offsetRay(point, normal, magnitude);
    light.distance = sqrt(distance2);
    light.direction = toLight / max(light.distance, 1e-37);
    const bool visible = cosine > 0.0 && face.doubleArea > 0.0;
    light.pdf = visible ? 2.0 * distance2 / (face.doubleArea * cosine) : 0.0;
    const vec2 order = (r0.w & LIGHT_MIRRORED) != 0u ? barycentrics.yx : barycentrics;
    light.radiance = visible ? lightEmission(r3, r2.w, order, cosine) : vec3(0.0);
    light.delta = false;
    return light;
}

LightSample samplePunctualLight(int at, vec3 from) {
    const uvec4 r0 = imageLoad(lights, at), r1 = imageLoad(lights, at + 1);
    const uvec4 r2 = imageLoad(lights, at + 2), r3 = imageLoad(lights, at + 3);
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
    light.pdf = 1.0;
    light.delta = true;
    return light;
}

/// Returns the shadow ray. It runs from start to target, both offset from their surfaces; along the original
/// direction the two offsets could cancel and let the light shadow itself.
Ray shadowRay(vec3 start, LightSample light) {
    if (light.distance == INFINITE_DISTANCE) return Ray(start, light.direction, INFINITE_DISTANCE);
    const vec3 path = light.target - start;
    const float distance = length(path);
    return Ray(start, path / max(distance, 1e-37), distance);
}

/// Returns how much of a punctual light a diffuse surface could use, ignoring visibility.
float usableLight(Receiver from, LightSample light) {
    const float cosine = dot(from.normal, light.direction);
    float usable = max(cosine, from.grazing);
    if (dot(from.geometricNormal, light.direction) <= 0.0) usable = 0.0;
    if (from.bothSides) usable = max(abs(cosine), 0.01);
    return luminance(light.radiance) * usable;
}

/// A punctual light for the point; pdf 0: no light reaches it.
struct PunctualChoice {
    int at;  // position in `lights`
    float pdf;
};

/// A light that may become the choice.
struct PunctualCandidate {
    int at;
    float weight, uniformWeight;
};

/// Evaluates all punctual lights. Chooses by usable light or, with probability PUNCTUAL_UNIFORM_SHARE, uniformly among
/// those with any, since the brightest may be occluded. Lights that are hidden by their distance maps count little in
/// both. One pass with two weighted reservoirs. (With more than 256 point and spot lights the light tree is used.)
PunctualChoice choosePunctualLight(Receiver from, SceneParams scene, inout uint rng) {
    float u = stratified(rng), v = random(rng);
    PunctualCandidate best = PunctualCandidate(0, 0.0, 0.0), any = best;
    float sum = 0.0, reaching = 0.0;
    for (uint index = 0u; index < scene.punctualCount; ++index) {
        const int at = int((scene.triangleLightCount + index) * LIGHT_TEXELS);
        const LightSample light = samplePunctualLight(at, from.position);
        PunctualCandidate tried = PunctualCandidate(at, usableLight(from, light), 1.0);
        if (!(tried.weight > 0.0)) continue;
        if (HAS_LIGHT_DISTANCES) {
            const Hidden hidden = hiddenByMap(index, light.direction, light.distance);
            tried.weight = max(tried.weight * weightFactor(hidden), 1e-37);
            if (hidden.surely) tried.uniformWeight = HIDDEN_UNIFORM_WEIGHT;
        }
        sum += tried.weight;
        reaching += tried.uniformWeight;
        const float share = tried.weight / sum, uniformShare = tried.uniformWeight / reaching;
        if (u < share) best = tried;
        if (v < uniformShare) any = tried;
        // The rescaled remainder of each number is again uniform.
        u = u < share ? u / share : (u - share) / (1.0 - share);
        v = v < uniformShare ? v / uniformShare : (v - uniformShare) / (1.0 - uniformShare);
    }
    if (random(rng) < PUNCTUAL_UNIFORM_SHARE) best = any;
    PunctualChoice choice = PunctualChoice(best.at, 0.0);
    if (reaching > 0.0) {
        const float share = best.weight / sum, uniformShare = best.uniformWeight / reaching;
        choice.pdf = mix(share, uniformShare, PUNCTUAL_UNIFORM_SHARE);
    }
    return choice;
}

LightShares lightShares(Receiver from, bool punctual, SceneParams scene) {
    LightShares shares = LightShares(HAS_ENVIRONMENT ? scene.environmentProbability : 0.0, 0.0, from);
    if (HAS_TRIANGLE_LIGHTS) shares.triangles = 1.0 - shares.environment;
    if (HAS_PUNCTUAL_LIGHTS) {
        shares.triangles *= punctual ? scene.triangleLightProbability : 1.0;
        // Without other lights, always sample the environment.
        if (HAS_ENVIRONMENT && !HAS_TRIANGLE_LIGHTS && !punctual) shares.environment = 1.0;
    }
    return shares;
}

/// Chooses an emissive triangle by lightPyramid. `u`, in [0,1), becomes its place in the triangle's interval.
uint chooseTriangle(uint count, inout float u) {
    uint at = 0u, first = 0u;
    for (int level = (findMSB(count * 2u - 1u) + 1) / 2; level > 0; --level) {
        const vec4 parts = imageLoad(lightPyramid, int(first + at));
        first += (count + (1u << (2 * level)) - 1u) >> (2 * level);
        at = 4u * at + takeOfFour(parts, u);
    }
    return at;
}

/// `choice`: a number in an interval of the width `share`, divided by it. `u`: the point on the light.
LightSample chooseTriangleLight(Receiver from, float choice, float share, vec2 u, SceneParams scene, inout uint rng) {
    const int at = int(chooseTriangle(scene.triangleLightCount, choice) * LIGHT_TEXELS);
    const uvec4 r1 = imageLoad(lights, at + 1);
    const float probability = uintBitsToFloat(r1.w);
    if (sharesNumbers()) u.x = placeWithin(choice, 1.0 / (share * probability), rng);
    LightSample light = sampleTriangleLight(imageLoad(lights, at), r1, imageLoad(lights, at + 2),
                                            imageLoad(lights, at + 3), from.position, u);
    light.pdf *= share * probability;
    return light;
}

LightSample noLight() {
    return LightSample(vec3(0.0), 0.0, vec3(0.0), vec3(0.0), 0.0, false);
}

/// Density of directions by the cosine at the surface.
float cosineDensity(Receiver from, vec3 direction) {
    const float cosine = dot(from.normal, direction);
    return from.bothSides ? abs(cosine) / (2.0 * PI) : max(cosine, 0.0) / PI;
}

EnvironmentSample sampleEvenEnvironment(Receiver from, vec2 u, SceneParams scene) {
    vec3 normal = from.normal;
    if (from.bothSides && takePart(1.0, 1.0, u.x) == 1u) normal = -normal;
    const vec3 direction = frameAround(normal) * sampleCosineHemisphere(u);
    return EnvironmentSample(direction, environmentRadiance(latLongOf(direction), scene), cosineDensity(from, direction));
}

LightSample environmentLight(Receiver from, vec2 u, SceneParams scene) {
    EnvironmentSample s;
    if (scene.environmentIsEven != 0u) {
        s = sampleEvenEnvironment(from, u, scene);
    } else {
        s = sampleEnvironment(u, scene);
    }
    return LightSample(s.direction, INFINITE_DISTANCE, vec3(0.0), s.radiance, s.pdf, false);
}

/// Samples a light by power, or punctual lights by choosePunctualLight().
LightSample sampleLightByPower(Receiver from, SceneParams scene, inout uint rng, out LightShares shares) {
    PunctualChoice punctual = PunctualChoice(0, 0.0);
    if (HAS_PUNCTUAL_LIGHTS) punctual = choosePunctualLight(from, scene, rng);
    shares = lightShares(from, punctual.pdf > 0.0, scene);
    float choice = 0.0;
    vec2 u = vec2(0.0);
    if (sharesNumbers()) {
        u = stratified2(rng);
        choice = u.x;
    } else {
        choice = random(rng);
        u = random2(rng);
    }
    LightSample light = noLight();
    if (HAS_ENVIRONMENT) {
        if (choice < shares.environment) {
            if (sharesNumbers()) u.x = placeWithin(choice / shares.environment, 1.0 / shares.environment, rng);
            light = environmentLight(from, u, scene);
            light.pdf *= shares.environment;
        }
    }
    const float rest = choice - shares.environment;
    if (HAS_TRIANGLE_LIGHTS) {
        if (rest >= 0.0 && (!HAS_PUNCTUAL_LIGHTS || rest < shares.triangles)) {
            const float share = max(shares.triangles, 1e-20);
            light = chooseTriangleLight(from, min(rest / share, 1.0 - 1.0 / float(0x01000000)), share, u, scene, rng);
        }
    }
    if (HAS_PUNCTUAL_LIGHTS) {
        if (punctual.pdf > 0.0 && rest >= shares.triangles) {
            light = samplePunctualLight(punctual.at, from.position);
            light.pdf = punctual.pdf * (1.0 - shares.environment - shares.triangles);
        }
    }
    return light;
}

/// A directional light, chosen by the irradiance it causes without shadows, and the irradiance of all.
struct SunChoice {
    int at;  // position in `lights`
    float probability, irradiance;
};

SunChoice chooseSun(Receiver from, SceneParams scene, inout uint rng) {
    SunChoice sun = SunChoice(0, 0.0, 0.0);
    float u = stratified(rng), chosen = 0.0;
    for (uint i = 0u; i < scene.sunCount; ++i) {
        const int at = int(imageLoad(lightTree, int(scene.firstSun + i)).x * LIGHT_TEXELS);
        const float weight = usableLight(from, samplePunctualLight(at, from.position));
        if (!(weight > 0.0)) continue;
        sun.irradiance += weight;
        const float share = weight / sun.irradiance;
        const bool taken = u < share;
        if (taken) {
            sun.at = at;
            chosen = weight;
        }
        // The rescaled remainder is again uniform.
        u = taken ? u / share : (u - share) / (1.0 - share);
    }
    sun.probability = chosen / max(sun.irradiance, 1e-30);
    return sun;
}

/// A light of the light list. The density does not include the probability of choosing this light.
LightSample sampleListedLight(uint index, Receiver from, vec2 u) {
    const int at = int(index * LIGHT_TEXELS);
    LightSample light = noLight();
    if (HAS_TRIANGLE_LIGHTS) {
        light = sampleTriangleLight(imageLoad(lights, at), imageLoad(lights, at + 1), imageLoad(lights, at + 2),
                                    imageLoad(lights, at + 3), from.position, u);
    }
    if (HAS_PUNCTUAL_LIGHTS) {
        const LightSample punctual = samplePunctualLight(at, from.position);
        const uint kind = imageLoad(lights, at).w & LIGHT_KIND_MASK;
        if (kind >= LIGHT_POINT) light = punctual;
    }
    return light;
}

/// The share of the light tree among it and directional lights, by the irradiance that they might cause.
float treeShare(ChosenLight chosen, SunChoice sun) {
    if (chosen.irradiance <= 0.0) return 0.0;
    if (!HAS_SUNS || sun.irradiance <= 0.0) return 1.0;
    const float share = chosen.irradiance / (chosen.irradiance + sun.irradiance);
    return clamp(share, MIN_TREE_OR_SUN_SHARE, 1.0 - MIN_TREE_OR_SUN_SHARE);
}

/// Samples the environment, a directional light or a light of the tree. Each gets samples only if it can reach the
/// point. One number chooses between environment and lights, walks the tree, and places the point on the light.
LightSample sampleLightByTree(Receiver from, SceneParams scene, inout uint rng, out LightShares shares) {
    const vec2 u = stratified2(rng);
    shares = LightShares(HAS_ENVIRONMENT ? scene.environmentProbability : 0.0, 0.0, from);
    float place = u.x;
    bool ofSky = false;
    if (HAS_ENVIRONMENT) ofSky = takePart(shares.environment, 1.0 - shares.environment, place) == 0u;
    float onLight = place;
    const ChosenLight chosen = chooseFromLightTree(from, scene.triangleLightCount, onLight, rng);
    SunChoice sun = SunChoice(0, 0.0, 0.0);
    if (HAS_SUNS) sun = chooseSun(from, scene, rng);
    if (HAS_ENVIRONMENT) {
        if (chosen.irradiance + sun.irradiance <= 0.0) {
            shares.environment = 1.0;
            ofSky = true;
            place = u.x;
        }
    }
    shares.triangles = (1.0 - shares.environment) * treeShare(chosen, sun);
    LightSample light = noLight();
    if (chosen.probability > 0.0) {
        light = sampleListedLight(chosen.light, from, vec2(onLight, u.y));
        light.pdf *= chosen.probability * shares.triangles;
    }
    if (HAS_SUNS) {
        const float suns = 1.0 - shares.environment - shares.triangles;
        if (stratified(rng) * (1.0 - shares.environment) >= shares.triangles && sun.probability > 0.0) {
            light = samplePunctualLight(sun.at, from.position);
            light.pdf = sun.probability * suns;
        }
    }
    if (HAS_ENVIRONMENT) {
        if (ofSky) {
            light = environmentLight(from, vec2(placeWithin(place, 1.0 / shares.environment, rng), u.y), scene);
            light.pdf *= shares.environment;
        }
    }
    return light;
}

/// Samples a light; pdf 0: no light reaches the point. `shares` are needed by lightPdf() and similar
/// functions for a ray that leaves from here.
LightSample sampleLight(Receiver from, SceneParams scene, inout uint rng, out LightShares shares) {
    if (LIGHT_TREE && HAS_LIGHT_TREE) return sampleLightByTree(from, scene, rng, shares);
    return sampleLightByPower(from, scene, rng, shares);
}

/// Returns the density per solid angle with which sampleLight draws the hit point of a ray of length
/// `distance`.
float lightPdf(Surface s, float distance, vec3 direction, LightShares shares, SceneParams scene) {
    const uint first = imageLoad(instances, int(s.instance * INSTANCE_TEXELS) + 3).y;
    if (first == NONE) return 0.0;
    float perArea;
    if (LIGHT_TREE && HAS_LIGHT_TREE) {
        const uvec4 trail = imageLoad(lightTree, int(scene.firstLightTrail + first + s.primitive));
        perArea = s.area > 0.0 ? lightTreeProbability(shares.from, scene.triangleLightCount, trail) / s.area : 0.0;
    } else {
        perArea = imageLoad(lightDensity, int(first + s.primitive)).x;
    }
    const float cosine = abs(dot(s.geometricNormal, direction));
    return cosine > 0.0 ? shares.triangles * perArea * distance * distance / cosine : 0.0;
}

/// Like lightPdf(), but for a ray that misses. `uv` is latLongOf(direction).
float environmentLightPdf(vec3 direction, vec2 uv, LightShares shares, SceneParams scene) {
    const bool even = scene.environmentIsEven != 0u;
    return shares.environment * (even ? cosineDensity(shares.from, direction) : environmentPdf(uv, scene));
}

#endif
