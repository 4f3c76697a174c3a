// How much less history counts whose normals reflect into other directions. docs/denoising.md, SVGF, step 2.
#ifndef LIMPID_LOBE_GLSL
#define LIMPID_LOBE_GLSL

const float MIN_LOBE_ALPHA = 0.02;  // of narrower lobes, which would leave few pixels to average
const float MAX_LOBE_SCALE = 1e4;   // more would compare the rounding of normals

/// Normals that differ by an angle d turn the reflected ray by 2 d, and the lobe of GGX is about as wide as its alpha,
/// the squared roughness. So the weight is exp(-(2 d / (lobe_test alpha))^2), with d^2 = 2 (1 - cosine). `lobeScale`:
/// 8 log2(e) / lobe_test^2. Returns history.glsl's normalScaleOf().
float lobeNormalScale(float roughness, float lobeScale) {
    const float alpha = max(roughness * roughness, MIN_LOBE_ALPHA);
    return min(lobeScale / (alpha * alpha), MAX_LOBE_SCALE);
}

#endif
