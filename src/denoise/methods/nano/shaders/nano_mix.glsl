// Mixes the network's light with SVGF's. Where it is included, these are declared beforehand: filteredA, filteredB,
// resultA, resultB, stableA, stableB, and the constants STABILISE and TWO_SIGNALS.
#include "denoise/methods/svgf/shaders/svgf_stable.glsl"

/// `svgf`: its light, and in the fourth component its deviation; negative: nothing is seen.
vec4 mixed(vec4 svgf, vec3 own, float share) {
    return svgf.a < 0.0 ? svgf : vec4(mix(svgf.rgb, own, share), svgf.a);
}

/// `shares`: of both signals' light, in the result. `to`: in the picture.
void storeMixed(ivec2 to, vec3 ownDiffuse, vec3 ownSpecular, vec2 shares) {
    const vec4 diffuse = mixed(LOAD_HALF4(filteredA, to), ownDiffuse, shares.x);
    const vec4 specular = mixed(LOAD_HALF4(filteredB, to), ownSpecular, shares.y);
    STORE_HALF4(resultA, to, diffuse);
    STORE_HALF4(resultB, to, specular);
    if (STABILISE) STORE_UINT1(stableA, to, packedStable(diffuse.rgb));
    if (STABILISE && TWO_SIGNALS) STORE_UINT1(stableB, to, packedStable(specular.rgb));
}
