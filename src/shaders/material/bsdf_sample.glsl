// Samples directions of a BSDF (bsdf.glsl).
#ifndef LIMPID_BSDF_SAMPLE_GLSL
#define LIMPID_BSDF_SAMPLE_GLSL

#include "shaders/material/bsdf_evaluate.glsl"

/// Samples a perfectly smooth lobe; value holds f cos / pdf of the lobe with pdf 1.
BsdfSample sampleSmooth(Bsdf b, uint lobe, float u) {
    BsdfSample result = BsdfSample(vec3(0.0), BsdfValue(vec3(0.0), vec3(0.0), 1.0), true, true);
    const vec3 reflected = vec3(-b.wo.xy, b.wo.z);
    vec3 wi = reflected;
    if (lobe == 1u) {
        result.value.specular = mirrorReflectance(b) / b.probability.y;
    } else if (lobe == 2u) {
        wi = -b.wo;
        // Rounding may choose this lobe although its chance is 0.
        result.value.specular = b.through * (1.0 - b.coatLoss) / max(b.probability.z, 1e-20);
    } else {
        const float reflectance = fresnelDielectric(b.wo.z, b.eta);
        const bool transmits = u >= reflectance;
        const float cosine = sqrt(max(0.0, b.wo.z * b.wo.z + (b.eta - 1.0) * (b.eta + 1.0)));
        wi = transmits ? -vec3(b.wo.xy, cosine) / b.eta : reflected;
        result.value.specular = (transmits ? b.glass : vec3(1.0)) * (b.glassWeight / b.probability.w);
    }
    if (HAS_SHEEN) result.value.specular *= evaluateSheen(b.sheen, b.wo, wi).y / (1.0 - b.sheen.probability);
    if (HAS_CLEARCOAT) result.value.specular *= (1.0 - b.clearcoat.albedo) / (1.0 - b.clearcoat.probability);
    result.direction = b.frame * wi;
    result.valid = sidesAgree(b, wi);
    return result;
}

/// Returns one of the two smooth lobes of clear glass, whole: value holds f cos / pdf without the chance to choose it.
BsdfSample clearGlassLobe(Bsdf b, bool transmits) {
    const bool pane = b.glassWeight == 0.0;
    BsdfSample result = sampleSmooth(b, pane ? 2u : 3u, 1.0);
    const float reflectance = pane ? 0.0 : fresnelDielectric(b.wo.z, b.eta);
    if (transmits) {
        result.value.specular *= pane ? b.probability.z : b.probability.w * (1.0 - reflectance);
    } else {
        result = sampleSmooth(b, 3u, -1.0);
        result.value.specular = mirrorReflectance(b) + b.glassWeight * reflectance;
    }
    result.valid = result.valid && result.value.specular != vec3(0.0);
    return result;
}

/// The share of light that goes straight on through a clear pane.
vec3 throughPane(Bsdf b) {
    const BsdfSample transmitted = clearGlassLobe(b, true);
    return transmitted.valid ? transmitted.value.specular : vec3(0.0);
}

/// Samples what the two smooth lobes of clear glass leave, which is diffuse. value holds f cos / pdf; its pdf is that
/// of evaluateBsdf().
BsdfSample clearGlassRest(Bsdf b, vec2 u) {
    const vec3 wi = sampleCosineHemisphere(u);
    BsdfSample result = BsdfSample(b.frame * wi, evaluateLocal(b, wi), false, wi.z > 0.0 && sidesAgree(b, wi));
    const float scale = PI / max(wi.z, 1e-20);
    result.value.diffuse *= scale;
    result.value.specular *= scale;
    return result;
}

/// Samples the coat instead of the base; the value is only set for a smooth coat.
BsdfSample sampleCoat(Bsdf b, vec2 u) {
    BsdfSample result = BsdfSample(vec3(0.0), BsdfValue(vec3(0.0), vec3(0.0), 1.0), b.clearcoat.smoothSurface, true);
    result.direction = sampleClearcoat(b.clearcoat, u);
    const float fresnel = clearcoatFresnel(b.clearcoat.wo.z);
    result.value.specular = vec3(b.clearcoat.weight * fresnel / max(b.clearcoat.probability, 1e-20));
    result.valid = dot(result.direction, b.geometricNormal) > 0.0 && dot(result.direction, b.clearcoat.frame[2]) > 0.0;
    return result;
}

/// Samples a local direction from the chosen lobe; z = 0 if there is none.
vec3 sampleRough(Bsdf b, uint lobe, vec2 u, float choice) {
    const vec3 m = HAS_ANISOTROPY ? sampleVisibleNormal(b.wo, b.alphas, u) : sampleVisibleNormal(b.wo, b.alpha, u);
    const float cosine = dot(b.wo, m);
    const vec3 reflected = 2.0 * cosine * m - b.wo;
    if (lobe == 1u) return reflected.z > 0.0 ? reflected : vec3(0.0);
    if (lobe == 2u) return reflected.z > 0.0 ? vec3(reflected.xy, -reflected.z) : vec3(0.0);
    if (!HAS_ROUGH_GLASS) return vec3(0.0);
    const float reflectance = fresnelDielectric(cosine, b.eta);
    if (choice < reflectionChance(b, reflectance)) return reflected.z > 0.0 ? reflected : vec3(0.0);
    const float transmitted = sqrt(max(0.0, cosine * cosine + (b.eta - 1.0) * (b.eta + 1.0)));
    const vec3 refracted = ((cosine - transmitted) * m - b.wo) / b.eta;
    return refracted.z < 0.0 ? refracted : vec3(0.0);
}

/// Samples what lies below coat and sheen, without its value unless the lobe is smooth. `wi`: the direction, local.
BsdfSample sampleBase(Bsdf b, vec2 u, inout uint rng, out vec3 wi) {
    uint lobe = 0u;
    float choice = 0.0;
    if (HAS_SPECULAR) {
        choice = sharesNumbers() ? u.x : random(rng);
        vec4 bounds = vec4(b.probability.xyz, 1.0 - b.belowProbability);
        bounds.y += bounds.x;
        bounds.z = bounds.w - b.probability.w;
        lobe = choice < bounds.x ? 0u : choice < bounds.y ? 1u : choice < bounds.z ? 2u : choice < bounds.w ? 3u : 4u;
        if (sharesNumbers()) {
            float low = 0.0, high = bounds.x;
            if (lobe > 0u) low = lobe == 1u ? bounds.x : lobe == 2u ? bounds.y : lobe == 3u ? bounds.z : bounds.w;
            if (lobe > 0u) high = lobe == 1u ? bounds.y : lobe == 2u ? bounds.z : lobe == 3u ? bounds.w : 1.0;
            const float scale = 1.0 / max(high - low, 1e-20);
            u.x = placeWithin((choice - low) * scale, scale, rng);
            choice = HAS_TRANSMISSION ? stratified(rng) : 0.0;
        } else {
            // Rescales the random number within its interval, to reuse it for the choice between reflection and
            // refraction.
            choice = clamp((choice - bounds.z) / max(b.probability.w, 1e-20), 0.0, 1.0);
        }
    }
    wi = sampleCosineHemisphere(u);
    if (HAS_SPECULAR) {
        const bool smoothLobe = b.smoothSurface || (lobe == 3u && b.roughGlass == 0.0);
        const bool diffuse = lobe == 0u || (HAS_DIFFUSE_TRANSMISSION && lobe == 4u);
        if (!diffuse && smoothLobe) return sampleSmooth(b, lobe, choice);
        if (lobe == 4u) wi.z = -wi.z;
        else if (lobe != 0u) wi = sampleRough(b, lobe, u, choice);
    }
    return BsdfSample(b.frame * wi, BsdfValue(vec3(0.0), vec3(0.0), 0.0), false, wi.z != 0.0 && sidesAgree(b, wi));
}

/// Samples a direction; value.diffuse + value.specular over value.pdf is the throughput. Values are computed in one
/// place for all layers: drivers copy functions to where they are called, and take long to compile many copies.
BsdfSample sampleBsdf(Bsdf b, inout uint rng) {
    const vec2 u = stratified2(rng);
    BsdfSample drawn;
    vec3 wi;
    bool below = true;
    if (HAS_CLEARCOAT) {
        if (stratified(rng) < b.clearcoat.probability) {
            drawn = sampleCoat(b, u);
            wi = drawn.direction * b.frame;
            below = false;
        }
    }
    if (HAS_SHEEN) {
        if (below && stratified(rng) < b.sheen.probability) {
            wi = sampleSheen(u);
            drawn.direction = b.frame * wi;
            drawn.delta = false;
            drawn.valid = wi.z > 0.0 && sidesAgree(b, wi);
            below = false;
        }
    }
    if (below) drawn = sampleBase(b, u, rng, wi);
    if (drawn.delta) return drawn;
    drawn.value = evaluateBsdf(b, wi, drawn.direction);
    drawn.valid = drawn.valid && drawn.value.pdf > 0.0;
    return drawn;
}

#endif
