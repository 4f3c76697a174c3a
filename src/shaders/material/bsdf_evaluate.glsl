// The value of a BSDF (bsdf.glsl) for two directions, and the density with which it is sampled.
#ifndef LIMPID_BSDF_EVALUATE_GLSL
#define LIMPID_BSDF_EVALUATE_GLSL

#include "shaders/material/bsdf_kinds.glsl"

/// True if wi is on the same side of the geometric normal as of the shading normal.
bool sidesAgree(Bsdf b, vec3 wi) {
    return dot(b.frame * wi, b.geometricNormal) * wi.z > 0.0;
}

float distributionOf(Bsdf b, vec3 m) {
    return HAS_ANISOTROPY ? ggxDistribution(m, b.alphas) : ggxDistribution(m, b.alpha);
}

float lambdaOf(Bsdf b, vec3 w) {
    return HAS_ANISOTROPY ? ggxLambda(w, b.alphas) : ggxLambda(w.z, b.alpha);
}

/// Returns the density of the half vector m seen from wo, converted to a density of the reflected direction.
float reflectionPdf(Bsdf b, vec3 m) {
    return distributionOf(b, m) / (4.0 * b.wo.z * (1.0 + lambdaOf(b, b.wo)));
}

/// Returns the diffuse-like part of a metal's multiple scattering: f for white metal. The product of missing
/// energies is from C. Kulla, A. Conty, "Revisiting physically based shading at Imageworks", SIGGRAPH 2017.
/// The remainder follows the single-facet lobe (addReflection).
float multipleReflection(Bsdf b, vec4 albedo) {
    const float missing = (1.0 - b.albedo.x - b.albedo.y) * (1.0 - albedo.x - albedo.y);
    return max(b.average.z * missing / (PI * max(1.0 - b.average.x - b.average.y, 1e-6)) + b.albedo.w * albedo.w, 0.0);
}

/// Returns the probability with which sampling reflects at a facet of this reflectance.
float reflectionChance(Bsdf b, float reflectance) {
    const float reflected = reflectance * (1.0 + b.glassGain.x);
    return reflected / (reflected + (1.0 - reflectance) * (1.0 + b.glassGain.y));
}

void addReflection(Bsdf b, vec3 wi, inout BsdfValue value) {
    const vec4 albedo = ggxAlbedo(wi.z, tableRoughness(b, wi));
    const float cosinePdf = wi.z / PI;
    const float coatLoss = coatAlbedo(b, albedo.xy);
    value.diffuse += b.diffuse * ((1.0 - b.coatLoss) * (1.0 - coatLoss) / max(1.0 - b.coatAverage, 1e-6) * cosinePdf);
    value.specular += multipleTint(b, wi.z) * (b.metal * multipleReflection(b, albedo) * wi.z);
    value.pdf += b.probability.x * cosinePdf;
    if (b.smoothSurface) return;
    const vec3 m = normalize(b.wo + wi);
    const float cosine = dot(b.wo, m);
    const float pdf = reflectionPdf(b, m);
    const float lambdaOut = lambdaOf(b, b.wo), lambdaIn = lambdaOf(b, wi);
    const vec3 fresnel = reflectanceAt(b, cosine);
    const float masking = (1.0 + lambdaOut) / (1.0 + lambdaOut + lambdaIn);
    vec3 metal = mix(b.metalF0, vec3(1.0), schlickWeight(cosine));
    if (HAS_IRIDESCENCE) {
        if (b.film.weight > 0.0) metal = filmedReflectance(b, cosine, b.metalF0, 1.0);
    }
    value.specular += (fresnel + metal * metal * (b.metal * b.albedo.z * albedo.z)) * (masking * pdf);
    value.pdf += b.probability.y * pdf;
    if (HAS_ROUGH_GLASS) {
        if (b.roughGlass > 0.0) {
            const float reflectance = fresnelDielectric(cosine, b.eta);
            value.specular += vec3(b.roughGlass * reflectance * pdf * (masking + b.glassGain.x));
            value.pdf += b.probability.w * reflectionChance(b, reflectance) * pdf;
        }
    }
}

void addTransmission(Bsdf b, vec3 wi, inout BsdfValue value) {
    if (b.smoothSurface) return;
    const vec3 mirrored = vec3(wi.xy, -wi.z);
    const vec3 paneHalf = normalize(b.wo + mirrored);
    const float panePdf = reflectionPdf(b, paneHalf);
    const float lambdaOut = lambdaOf(b, b.wo), lambdaIn = lambdaOf(b, mirrored);
    const float single = b.albedo.x + b.albedo.y;
    value.specular +=
        b.through * ((1.0 - b.coatLoss) / single * panePdf * (1.0 + lambdaOut) / (1.0 + lambdaOut + lambdaIn));
    value.pdf += b.probability.z * panePdf;
    if (!HAS_ROUGH_GLASS) return;
    vec3 m = b.wo + b.eta * wi;
    m *= m.z < 0.0 ? -1.0 : 1.0;
    const float length2 = dot(m, m);
    m *= inversesqrt(max(length2, 1e-20));
    const float cosOut = dot(b.wo, m), cosIn = dot(wi, m);
    if (cosOut <= 0.0 || cosIn >= 0.0 || b.roughGlass <= 0.0) return;
    const float reflectance = fresnelDielectric(cosOut, b.eta);
    const float root = cosOut + b.eta * cosIn;
    const float pdf = distributionOf(b, m) * cosOut / (b.wo.z * (1.0 + lambdaOut)) *
                      (b.eta * b.eta * -cosIn / max(root * root, 1e-20));
    const float masking = transmittedMasking(lambdaOut, lambdaIn);
    value.specular += b.glass * (b.roughGlass * (1.0 - reflectance) * pdf * (masking + b.glassGain.y));
    value.pdf += b.probability.w * (1.0 - reflectionChance(b, reflectance)) * pdf;
}

/// Adds the diffuse-like part of multiple scattering at a refracting boundary: a product of the missing
/// energies of both directions, as for metals; for transmission, the missing energy seen from the other side.
/// The remainder follows the single-facet lobes: the gains in addReflection and addTransmission.
void addDielectricMultiple(Bsdf b, vec3 wi, inout BsdfValue value) {
    const bool above = wi.z > 0.0;
    const float cosinePdf = abs(wi.z) / PI;
    const vec4 entry = dielectricEntry(abs(wi.z), b.roughness, above ? b.eta : 1.0 / b.eta, 1);
    const vec2 lobes = b.glassDiffuse * entry.xy / max(entry.zw, vec2(1e-6));
    value.specular += (above ? vec3(lobes.x) : b.glass * lobes.y) * (b.roughGlass * cosinePdf);
    if (!HAS_DIFFUSE_TRANSMISSION) value.pdf += above ? 0.0 : b.belowProbability * cosinePdf;
}

/// Adds the light that the base transmits: like plastic's diffuse light, through a coat on either side.
void addDiffuseTransmission(Bsdf b, vec3 wi, inout BsdfValue value) {
    const vec4 albedo = ggxAlbedo(-wi.z, tableRoughness(b, wi));
    const float cosinePdf = -wi.z / PI;
    const float coatLoss = coatAlbedo(b, albedo.xy);
    value.diffuse +=
        b.diffuseBelow * ((1.0 - b.coatLoss) * (1.0 - coatLoss) / max(1.0 - b.coatAverage, 1e-6) * cosinePdf);
    value.pdf += b.belowProbability * cosinePdf;
}

/// Returns f cos and the density with which sampleBsdf draws wi (local), without perfectly smooth lobes.
BsdfValue evaluateLocal(Bsdf b, vec3 wi) {
    BsdfValue value = BsdfValue(vec3(0.0), vec3(0.0), 0.0);
    if (!HAS_SPECULAR) {
        value.pdf = max(wi.z, 0.0) / PI;
        value.diffuse = b.diffuse * value.pdf;
        return value;
    }
    if (wi.z > 0.0) addReflection(b, wi, value);
    if (HAS_TRANSMISSION) {
        if (wi.z < 0.0) addTransmission(b, wi, value);
    }
    if (HAS_ROUGH_GLASS) {
        if (b.roughGlass > 0.0) addDielectricMultiple(b, wi, value);
    }
    if (HAS_DIFFUSE_TRANSMISSION) {
        if (wi.z < 0.0) addDiffuseTransmission(b, wi, value);
    }
    return value;
}

/// `wi` is the same direction as `direction`.
BsdfValue evaluateBsdf(Bsdf b, vec3 wi, vec3 direction) {
    BsdfValue value = evaluateLocal(b, wi);
    if (!sidesAgree(b, wi)) value = BsdfValue(vec3(0.0), vec3(0.0), 0.0);
    if (HAS_SHEEN) {
        const vec3 sheen = evaluateSheen(b.sheen, b.wo, wi);
        value.diffuse *= sheen.y;
        value.specular *= sheen.y;
        if (sidesAgree(b, wi)) {
            value.specular += b.sheen.color * sheen.x;
            value.pdf = mix(value.pdf, sheen.z, b.sheen.probability);
        }
    }
    if (HAS_CLEARCOAT) {
        const vec2 coat = evaluateClearcoat(b.clearcoat, b.geometricNormal, direction);
        value.diffuse *= 1.0 - b.clearcoat.albedo;
        value.specular = value.specular * (1.0 - b.clearcoat.albedo) + coat.x;
        value.pdf = mix(value.pdf, coat.y, b.clearcoat.probability);
    }
    return value;
}

BsdfValue evaluateBsdf(Bsdf b, vec3 direction) {
    return evaluateBsdf(b, direction * b.frame, direction);
}

#endif
