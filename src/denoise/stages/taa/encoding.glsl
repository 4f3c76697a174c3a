// The colours that anti-aliasing takes means of. docs/denoising.md, E of "Temporal anti-aliasing".
#ifndef LIMPID_TAA_ENCODING_GLSL
#define LIMPID_TAA_ENCODING_GLSL

/// Luma and two chromas of a compressed colour: bright pixels weigh less, as they will on a screen.
vec3 encode(vec3 c) {
    const vec3 shown = c / (1.0 + luminance(c));
    return vec3(dot(shown, vec3(0.25, 0.5, 0.25)), dot(shown, vec3(0.5, 0.0, -0.5)), dot(shown, vec3(-0.25, 0.5, -0.25)));
}

vec3 decode(vec3 v) {
    const vec3 shown = max(vec3(v.x + v.y - v.z, v.x + v.z, v.x - v.y - v.z), vec3(0.0));
    return shown / max(1.0 - luminance(shown), 1e-6);
}

/// Luminance of a compressed colour.
float encodedLuminance(vec3 v) {
    return luminance(vec3(v.x + v.y - v.z, v.x + v.z, v.x - v.y - v.z));
}

/// Scales a compressed colour down to a luminance.
vec3 notBrighter(vec3 v, float most) {
    return v * min(1.0, most / max(encodedLuminance(v), 1e-20));
}

#endif
