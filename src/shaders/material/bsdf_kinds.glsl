// Kinds of BSDFs (bsdf.glsl) that paths treat in their own ways.
#ifndef LIMPID_BSDF_KINDS_GLSL
#define LIMPID_BSDF_KINDS_GLSL

#include "shaders/material/bsdf_make.glsl"

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

#endif
