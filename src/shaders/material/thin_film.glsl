// KHR_materials_iridescence: reflectance of a surface below a thin film, in which light interferes: L. Belcour, P. Barla,
// "A practical extension to microfacet theory for the modeling of varying iridescence", SIGGRAPH 2017, with the
// extension's simplifications: Schlick's reflectances, no polarisation, and a base without absorption.
#ifndef LIMPID_THIN_FILM_GLSL
#define LIMPID_THIN_FILM_GLSL

#include "shaders/material/microfacet.glsl"

struct ThinFilm {
    float weight, ior;
    float thickness;  // nanometres
};

/// Returns the Fourier transform of the colour matching functions (sums of Gaussians, fitted by Belcour and Barla), in
/// linear Rec. 709, at an optical path difference in nanometres.
vec3 filmSensitivity(float path, vec3 shift) {
    const float phase = 2.0 * PI * path * 1e-9;
    const vec3 value = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13);
    const vec3 position = vec3(1.6810e6, 1.7953e6, 2.2084e6), variance = vec3(4.3278e9, 9.3046e9, 6.6121e9);
    vec3 xyz = value * sqrt(2.0 * PI * variance) * cos(position * phase + shift) * exp(-phase * phase * variance);
    xyz.x += 9.7470e-14 * sqrt(2.0 * PI * 4.5282e9) * cos(2.2399e6 * phase + shift.x) * exp(-4.5282e9 * phase * phase);
    return mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560,
                1.0572252) * (xyz / 1.0685e-7);
}

/// `f0`: reflectance of the surface without the film, at normal incidence.
vec3 thinFilmReflectance(ThinFilm film, float cosine, vec3 f0) {
    const float ior = film.ior;
    const float inside2 = 1.0 - (1.0 - cosine * cosine) / (ior * ior);
    if (inside2 <= 0.0) return vec3(1.0);
    const float inside = sqrt(inside2);
    const float outerRoot = (ior - 1.0) / (ior + 1.0);
    const float outer = mix(outerRoot * outerRoot, 1.0, schlickWeight(cosine)), through = 1.0 - outer;
    const vec3 root = sqrt(clamp(f0, 0.0, 0.9999));
    const vec3 base = (1.0 + root) / (1.0 - root), innerRoot = (base - ior) / (base + ior);
    const vec3 inner = mix(innerRoot * innerRoot, vec3(1.0), schlickWeight(inside));
    // Phases of the reflections inside the film: half a wave at its outside, which is thinner, and at a thinner base.
    const vec3 shift = PI + PI * vec3(lessThan(base, vec3(ior)));
    const vec3 both = clamp(outer * inner, 1e-5, 0.9999), amplitude = sqrt(both);
    const vec3 mean = through * through * inner / (1.0 - both);
    const float path = 2.0 * ior * film.thickness * inside;
    vec3 sum = outer + mean, order = mean - through;
    for (int m = 1; m <= 2; ++m) {
        order *= amplitude;
        sum += order * 2.0 * filmSensitivity(float(m) * path, float(m) * shift);
    }
    return clamp(sum, 0.0, 1.0);
}

#endif
