// From a surface to its BSDF (bsdf.glsl): albedos of its layers, and the probabilities of its lobes.
#ifndef LIMPID_BSDF_MAKE_GLSL
#define LIMPID_BSDF_MAKE_GLSL

#include "shaders/material/bsdf_type.glsl"

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

/// Returns the coat's reflection of uniform light in its strongest channel, of the two terms of the albedo. At most 1,
/// also where rounding says more: a lobe below the coat would have a negative chance.
float coatAlbedo(Bsdf b, vec2 albedo) {
    if (HAS_IRIDESCENCE) {
        if (b.film.weight > 0.0) {
            const vec3 r = filmedReflectance(b, meanCosine(albedo), b.plasticF0, b.coatF90);
            return min((albedo.x + albedo.y) * max(r.r, max(r.g, r.b)), 1.0);
        }
    }
    return min(b.coatF0 * albedo.x + b.coatF90 * albedo.y, 1.0);
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

#endif
