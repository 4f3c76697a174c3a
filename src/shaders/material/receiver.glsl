// Where the light of a surface may come from, with the extensions that few materials have.
#ifndef LIMPID_RECEIVER_GLSL
#define LIMPID_RECEIVER_GLSL

#include "shaders/material/lights.glsl"

/// receiverAt(), for materials that transmit light diffusely, and for sheen, for which the cosine does not matter.
Receiver litAt(Surface surface) {
    Receiver receiver = receiverAt(surface);
    if (HAS_DIFFUSE_TRANSMISSION) receiver.bothSides = receiver.bothSides || transmitsLight(surface);
    if (HAS_SHEEN) {
        if (surface.sheenColor != vec3(0.0)) receiver.grazing = max(receiver.grazing, 0.1);
    }
    return receiver;
}

#endif
