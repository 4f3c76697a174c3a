// The material's BSDF: glTF 2.0 metallic-roughness with transmission, below sheen (sheen.glsl), below a clear coat
// (clearcoat.glsl).
//
//   f = metallic * metal + (1 - metallic) * ((1 - transmission) * plastic + transmission * glass)
//
// With iridescence, metal and plastic lie below a film (thin_film.glsl). With diffuse transmission, plastic's base
// sends a share of its light to the other side of the surface. With anisotropy, all facets have two roughnesses, and
// multiple scattering is left out (docs/gltf.md).
//
// metal: GGX reflection plus multiple scattering between the facets (multipleReflection). plastic: GGX
// reflection over a diffuse base that gets exactly the energy that the coat transmits, in and out. glass:
// thin (a pane: the transmitted lobe is the reflected one mirrored behind the surface) or a refracting
// boundary, plus multiple scattering (addDielectricMultiple). Both multiple-scattering terms are fitted to a
// random walk on microfacets (E. Heitz et al., "Multiple-scattering microfacet BSDFs with the Smith model",
// SIGGRAPH 2016; tests/reference/microfacet_walk.h; docs/gltf.md). A white surface of any kind reflects and
// transmits all energy. Energy form: crossing a boundary does not scale radiance by eta^2; the factors cancel
// for every path that leaves the body again.
//
// All f below include the cosine. Directions are local: the shading normal is +Z.
#ifndef LIMPID_BSDF_GLSL
#define LIMPID_BSDF_GLSL

#include "shaders/material/clearcoat.glsl"
#include "shaders/material/material.glsl"
#include "shaders/material/microfacet.glsl"
#include "shaders/material/sheen.glsl"
#include "shaders/material/thin_film.glsl"

struct Bsdf {
    mat3 frame;
    vec3 wo;
    vec3 geometricNormal;  // world space, on the viewer's side
    vec3 diffuse;          // albedo of the base below the coat
    vec3 diffuseBelow;     // the same for light that the base transmits
    vec3 f0;               // Schlick's terms of the reflecting lobe
    float f90;
    float coatF0, coatF90;  // of the dielectric coat alone
    float metal;           // weight of the metal
    vec3 metalF0;
    vec3 multiple;         // roughly the share of white light that remains after several facets of the metal
    vec3 through;          // tint and weight of the thin pane's transmitted lobe
    vec3 glass;            // tint of the refracting boundary's transmitted light
    float glassWeight;     // of the refracting boundary
    float roughGlass;      // same, but 0 if its lobes are perfectly smooth
    float alpha, roughness, eta;
    vec2 alphas;       // of the frame's x and y, with anisotropy
    float anisotropy;  // its strength
    bool smoothSurface;
    vec4 albedo;     // ggxAlbedo at wo
    vec3 average;    // ggxAverage
    float coatLoss;     // share of energy that the coat keeps from the base at wo
    float coatAverage;  // the same, of light from all directions
    vec2 glassGain;     // multiple scattering's gain of the refracting boundary's two lobes, without masking
    vec2 glassDiffuse;  // diffuse-like part of multiple scattering at the boundary: reflected and transmitted
    vec4 probability;   // of sampling the diffuse, reflecting, thin transmitting and refracting lobe
    float belowProbability;  // of sampling the diffuse-like transmission
    ThinFilm film;         // over metal and plastic
    vec3 plasticF0;        // of the dielectric without its specular factor
    vec3 filmedF0;         // mean reflectance of the metal's facets
    vec3 filmedMirror;     // reflectance of facets that face the viewer's mirrored direction
    float plainMetal, plastic;  // weights of the metal and of the dielectric below the film
    Sheen sheen;
    Clearcoat clearcoat;
};

struct BsdfValue {
    vec3 diffuse, specular;  // f cos
    float pdf;
};

struct BsdfSample {
    vec3 direction;  // world
    BsdfValue value;
    bool delta;       // only BSDF sampling can find this direction
    bool valid;
};

Bsdf lambertianBsdf(Surface s, vec3 toViewer) {
    Bsdf b;
    b.frame = frameAround(s.normal);
    if (HAS_ANISOTROPY) {
        if (s.anisotropy > 0.0) b.frame = frameAlong(s.normal, s.anisotropyDirection);
    }
    b.wo = toViewer * b.frame;
    b.geometricNormal = s.geometricNormal;
    b.diffuse = s.unlit ? vec3(0.0) : s.baseColor;
    return b;
}

/// Returns the tint of white light that several facets of the metal reflect from wo to this cosine. f: the
/// mean Fresnel term of such facets; e: the fraction that escapes after each. Both are fitted to random walks
/// at roughness 0.5 to 1.
vec3 multipleTint(Bsdf b, float cosine) {
    const float x = min(1.0 - b.roughness, 0.5);
    const vec2 grazing = 1.0 - vec2(b.wo.z, cosine);
    const float e = min(0.48 + x * (0.89 - 0.66 * x) + (0.2 - 0.095 * x) * (grazing.x + grazing.y), 1.0);
    const float s = 0.014 + 0.08 * x + (0.069 + x * (1.125 * x - 0.105)) * dot(grazing, grazing);
    vec3 f = mix(b.metalF0, vec3(1.0), s);
    if (HAS_IRIDESCENCE) {
        if (b.film.weight > 0.0) f = mix(b.filmedF0, vec3(1.0), s);
    }
    return f * f * e / (1.0 - f * (1.0 - e));
}

/// Returns the roughness whose albedos in the tables stand for those of anisotropic facets seen from w: by the facets'
/// slopes towards w, less a share that makes them reflect no less than they do (fitted; within 0.3 % for a dielectric).
float tableRoughness(Bsdf b, vec3 w) {
    if (!HAS_ANISOTROPY) return b.roughness;
    const float sine2 = dot(w.xy, w.xy);
    const float along = sine2 > 1e-8 ? length(b.alphas * w.xy) * inversesqrt(sine2) : b.alphas.y;
    return b.anisotropy > 0.0 ? sqrt(along * (1.0 - 0.5 * b.anisotropy)) : b.roughness;
}

/// KHR_materials_anisotropy: one axis is rougher. Light that several facets of such a metal or glass scatter is lost.
void makeAnisotropic(inout Bsdf b, Surface s) {
    b.alphas = vec2(b.alpha);
    b.anisotropy = s.anisotropy;
    if (s.anisotropy <= 0.0) return;
    const float least = SMOOTH_ROUGHNESS * SMOOTH_ROUGHNESS;
    const float along = mix(b.alpha, 1.0, s.anisotropy * s.anisotropy);
    b.smoothSurface = along < least;
    b.alphas = max(vec2(along, b.alpha), vec2(least));
    b.metal = 0.0;
}

/// Returns a facet's reflectance below the film: of Schlick's terms f0, which is multiplied by f90, and f90.
vec3 filmedReflectance(Bsdf b, float cosine, vec3 f0, float f90) {
    const vec3 plain = mix(f0, vec3(1.0), schlickWeight(cosine));
    return f90 * mix(plain, thinFilmReflectance(b.film, cosine, f0), b.film.weight);
}

/// Returns the reflectance of the reflecting lobe's facets.
vec3 reflectanceAt(Bsdf b, float cosine) {
    if (HAS_IRIDESCENCE) {
        if (b.film.weight > 0.0) {
            return b.plainMetal * filmedReflectance(b, cosine, b.metalF0, 1.0) +
                   b.plastic * filmedReflectance(b, cosine, b.plasticF0, b.coatF90);
        }
    }
    return mix(b.f0, vec3(b.f90), schlickWeight(cosine));
}

/// Returns reflectanceAt() where light is mirrored by the surface itself.
vec3 mirrorReflectance(Bsdf b) {
    if (HAS_IRIDESCENCE) return b.filmedMirror;
    return mix(b.f0, vec3(b.f90), schlickWeight(b.wo.z));
}

/// The cosine of facets that stands for all that are seen: where Schlick's term has its mean over the lobe.
/// `albedo`: of ggxAlbedo or ggxAverage.
float meanCosine(vec2 albedo) {
    return 1.0 - pow(clamp(albedo.y / max(albedo.x + albedo.y, 1e-6), 0.0, 1.0), 0.2);
}

/// Returns the coat's reflection of uniform light in its strongest channel, of the two terms of the albedo.
float coatAlbedo(Bsdf b, vec2 albedo) {
    if (HAS_IRIDESCENCE) {
        if (b.film.weight > 0.0) {
            const vec3 r = filmedReflectance(b, meanCosine(albedo), b.plasticF0, b.coatF90);
            return (albedo.x + albedo.y) * max(r.r, max(r.g, r.b));
        }
    }
    return b.coatF0 * albedo.x + b.coatF90 * albedo.y;
}

/// Returns its mean over all directions. A film's mean is less certain: it is taken so low that nothing gains energy.
float coatAverage(Bsdf b) {
    const float average = coatAlbedo(b, b.average.xy);
    return HAS_IRIDESCENCE && b.film.weight > 0.0 ? 0.9 * average : average;
}

/// Returns the same as coatAlbedo() for the whole reflecting lobe, in colour.
vec3 reflectedAlbedo(Bsdf b) {
    if (HAS_IRIDESCENCE) {
        if (b.film.weight > 0.0) return (b.albedo.x + b.albedo.y) * reflectanceAt(b, meanCosine(b.albedo.xy));
    }
    return b.f0 * b.albedo.x + b.f90 * b.albedo.y;
}

void makeRoughGlass(inout Bsdf b, Surface s) {
    b.roughGlass = 0.0;
    b.glassGain = vec2(0.0);
    b.glassDiffuse = vec2(0.0);
    if (!HAS_ROUGH_GLASS) return;
    b.roughGlass = b.smoothSurface || abs(s.ior - 1.0) < SMOOTH_IOR_DIFFERENCE ? 0.0 : b.glassWeight;
    if (b.roughGlass <= 0.0 || (HAS_ANISOTROPY && s.anisotropy > 0.0)) return;
    const vec4 entry = dielectricEntry(b.wo.z, b.roughness, b.eta, 0);
    b.glassGain = entry.xy;
    b.glassDiffuse = entry.zw;
}

/// Sets the probabilities of the lobes by the light that they scatter, and returns its sum.
float chooseLobes(inout Bsdf b) {
    const float missing = luminance(b.multiple) * (1.0 - b.albedo.x - b.albedo.y);
    const vec2 spread = b.glassDiffuse * b.glassWeight;
    const vec4 weights = vec4(luminance(b.diffuse) * (1.0 - b.coatLoss) + missing * b.average.z + spread.x,
                              luminance(reflectedAlbedo(b)) + missing * (1.0 - b.average.z),
                              luminance(b.through) * (1.0 - b.coatLoss), b.glassWeight - spread.x - spread.y);
    float below = spread.y;
    if (HAS_DIFFUSE_TRANSMISSION) below += luminance(b.diffuseBelow) * (1.0 - b.coatLoss);
    const float sum = dot(weights, vec4(1.0)) + below;
    b.probability = weights / max(sum, 1e-20);
    b.belowProbability = below / max(sum, 1e-20);
    return sum;
}

Bsdf makeBsdf(Surface s, vec3 toViewer) {
    Bsdf b = lambertianBsdf(s, toViewer);
    if (!HAS_SPECULAR) return b;
    const float dielectric = s.unlit ? 0.0 : 1.0 - s.metallic;
    const float metal = s.unlit ? 0.0 : s.metallic;
    const float transmission = HAS_TRANSMISSION ? s.transmission : 0.0;
    const float refracting = s.thin ? 0.0 : dielectric * transmission;
    b.roughness = s.roughness;
    b.alpha = max(s.roughness * s.roughness, 1e-4);
    b.smoothSurface = s.roughness < SMOOTH_ROUGHNESS;
    b.metal = metal;
    if (HAS_ANISOTROPY) makeAnisotropic(b, s);
    b.eta = s.front ? s.ior : 1.0 / s.ior;
    const float root = (s.ior - 1.0) / (s.ior + 1.0);
    // KHR_materials_specular: the base gets what the coat's strongest channel transmits.
    b.plasticF0 = min(root * root * s.specularColor, vec3(1.0));
    const vec3 coatF0 = b.plasticF0 * s.specular;
    b.coatF0 = max(coatF0.r, max(coatF0.g, coatF0.b));
    b.coatF90 = s.specular;
    b.f0 = metal * s.baseColor + (dielectric - refracting) * coatF0;
    b.f90 = metal + (dielectric - refracting) * b.coatF90;
    b.albedo = ggxAlbedo(b.wo.z, tableRoughness(b, b.wo));
    b.metalF0 = s.baseColor;
    if (HAS_IRIDESCENCE) {
        const float weight = s.unlit ? 0.0 : s.iridescence * smoothstep(0.0, 0.03, s.iridescenceThickness);
        b.film = ThinFilm(weight, s.iridescenceIor, s.iridescenceThickness);
        b.plainMetal = metal;
        b.plastic = dielectric - refracting;
    }
    b.coatLoss = coatAlbedo(b, b.albedo.xy);
    b.diffuse = s.baseColor * (dielectric * (1.0 - transmission));
    b.diffuseBelow = vec3(0.0);
    if (HAS_DIFFUSE_TRANSMISSION) {
        b.diffuseBelow = s.diffuseTransmissionColor * (dielectric * (1.0 - transmission) * s.diffuseTransmission);
        b.diffuse *= 1.0 - s.diffuseTransmission;
    }
    b.through = s.thin ? s.baseColor * (dielectric * transmission) : vec3(0.0);
    b.glassWeight = refracting;
    b.glass = s.baseColor;
    makeRoughGlass(b, s);
    b.average = ggxAverage(tableRoughness(b, vec3(1.0, 0.0, 0.0)));
    b.coatAverage = coatAverage(b);
    if (HAS_IRIDESCENCE) {
        b.filmedF0 = filmedReflectance(b, meanCosine(b.average.xy), b.metalF0, 1.0);
        b.filmedMirror = reflectanceAt(b, b.wo.z);
    }
    b.multiple = b.metal * multipleTint(b, 2.0 / 3.0);
    float sum = chooseLobes(b);
    if (HAS_SHEEN) {
        b.sheen = makeSheen(s, b.wo.z, sum);
        sum = mix(sum, 1.0, b.sheen.albedo);
    }
    if (HAS_CLEARCOAT) b.clearcoat = makeClearcoat(s, toViewer, sum);
    return b;
}

bool hasSheen(Bsdf b) {
    return HAS_SHEEN && b.sheen.color != vec3(0.0);
}

bool transmitsDiffusely(Bsdf b) {
    return HAS_DIFFUSE_TRANSMISSION && b.diffuseBelow != vec3(0.0);
}

/// True if all light is reflected in a single direction.
bool isPerfectMirror(Bsdf b) {
    if (!HAS_SPECULAR) return false;
    if (HAS_CLEARCOAT) {
        if (b.clearcoat.weight > 0.0) return false;
    }
    if (hasSheen(b) || transmitsDiffusely(b)) return false;
    return b.smoothSurface && b.diffuse == vec3(0.0) && b.through == vec3(0.0) && b.glassWeight == 0.0 && b.f90 > 0.0;
}

/// True if the surface transmits light.
bool isTransmitting(Bsdf b) {
    return b.glassWeight > 0.0 || b.through != vec3(0.0);
}

const float CLEAR_GLASS_DIFFUSE = 0.25;  // the rest of clear glass's light is in its two smooth lobes

/// True if nearly all light is reflected in one direction or transmitted in another: smooth glass, or a smooth pane.
bool isClearGlass(Bsdf b) {
    if (!HAS_TRANSMISSION) return false;
    if (HAS_CLEARCOAT) {
        if (b.clearcoat.weight > 0.0) return false;
    }
    if (hasSheen(b) || transmitsDiffusely(b)) return false;
    const bool smoothLobes = b.roughGlass == 0.0 && (b.smoothSurface || b.glassWeight == 1.0);
    return isTransmitting(b) && smoothLobes && b.probability.x <= CLEAR_GLASS_DIFFUSE;
}

/// True for a smooth pane, through which light goes straight on.
bool isClearPane(Bsdf b) {
    return b.glassWeight == 0.0 && isClearGlass(b);
}

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

/// Samples a perfectly smooth lobe; value holds f cos / pdf of the lobe with pdf 1.
BsdfSample sampleSmooth(Bsdf b, uint lobe, float u) {
    BsdfSample result = BsdfSample(vec3(0.0), BsdfValue(vec3(0.0), vec3(0.0), 1.0), true, true);
    const vec3 reflected = vec3(-b.wo.xy, b.wo.z);
    vec3 wi = reflected;
    if (lobe == 1u) {
        result.value.specular = mirrorReflectance(b) / b.probability.y;
    } else if (lobe == 2u) {
        wi = -b.wo;
        result.value.specular = b.through * (1.0 - b.coatLoss) / b.probability.z;
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

/// Returns the specular lobes' reflection and transmission of uniform light: the albedoSpecular layer.
vec3 specularAlbedo(Bsdf b) {
    if (!HAS_SPECULAR) return vec3(0.0);
    const float missing = 1.0 - b.albedo.x - b.albedo.y;
    const float reflectance = fresnelDielectric(b.wo.z, b.eta);
    vec3 base = reflectedAlbedo(b) + b.multiple * missing + b.through * (1.0 - b.coatLoss) +
                      b.glassWeight * mix(b.glass, vec3(1.0), reflectance);
    if (HAS_SHEEN) base = base * (1.0 - b.sheen.albedo) + b.sheen.color * min(b.sheen.outside, 1.0);
    return HAS_CLEARCOAT ? base * (1.0 - b.clearcoat.albedo) + b.clearcoat.albedo : base;
}

#endif
