// Two distances in 32 bits, each the upper half of a float.
#ifndef LIMPID_DISTANCE_PAIR_GLSL
#define LIMPID_DISTANCE_PAIR_GLSL

/// The least value with 16 bits that is not below the distance.
uint halfAbove(float distance) {
    return (floatBitsToUint(distance) + 0xFFFFu) >> 16;
}

float packDistances(float lower, float upper) {
    return uintBitsToFloat(halfAbove(upper) << 16 | halfAbove(lower));
}

float lowerDistance(float both) {
    return uintBitsToFloat(floatBitsToUint(both) << 16);
}

float upperDistance(float both) {
    return uintBitsToFloat(floatBitsToUint(both) & 0xFFFF0000u);
}

#endif
