// How far behind a glossy surface its reflections appear to be.
#ifndef LIMPID_REFLECTION_SHARE_GLSL
#define LIMPID_REFLECTION_SHARE_GLSL

/// On rougher surfaces, reflected light is assumed to move with the surface.
const float MAX_REFLECTING_ROUGHNESS = 0.3;

/// The depth of the reflected image behind the surface, as a share of a perfect mirror's: the lobe's dominant
/// direction leans from the mirrored direction towards the normal by the same share (S. Lagarde and C. de
/// Rousiers, "Moving Frostbite to Physically Based Rendering", 2014, section 4.9). 0: it moves with the surface, also
/// where the roughness is unknown (negative or NaN).
float reflectionShare(float roughness) {
    if (!(roughness >= 0.0 && roughness < MAX_REFLECTING_ROUGHNESS)) return 0.0;
    const float smoothness = 1.0 - roughness;
    return smoothness * (sqrt(smoothness) + roughness);
}

#endif
