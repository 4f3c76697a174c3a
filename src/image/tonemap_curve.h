// The constants of the PNG view, in the words that C++ and GLSL share: this file is included by both.
//
// The curve is Krzysztof Narkowicz's fit of the ACES filmic tone mapping ("ACES Filmic Tone Mapping Curve",
// 2016, https://knarkowicz.wordpress.com/2016/01/06/aces-filmic-tone-mapping-curve/), with the factor 0.6
// that he gives for the original's brightness:  y = x (A x + B) / (x (C x + D) + E),  x = 0.6 * exposed
// radiance, clamped to [0,1].
#ifndef LIMPID_IMAGE_TONEMAP_CURVE_H
#define LIMPID_IMAGE_TONEMAP_CURVE_H

const float filmicScale = 0.6f;
const float filmicA = 2.51f;
const float filmicB = 0.03f;
const float filmicC = 2.43f;
const float filmicD = 0.59f;
const float filmicE = 0.14f;
/// Radiance is clamped to this before the curve, whose squares would overflow. The curve reaches 1 long
/// before.
const float filmicLargest = 65504.0f;
/// The average luminance after automatic exposure.
const float filmicKey = 0.18f;

#endif
