// The constants of tone curves, in the words that C++ and GLSL share: this file is included by both.
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
/// Of pictures for displays of a high dynamic range, relative to paper white: 10,000 cd/m^2, which is the
/// most that any display signal can say, where paper white is 80 cd/m^2.
const float extendedLargest = 125.0f;
/// The average luminance after automatic exposure.
const float filmicKey = 0.18f;

// AgX by Troy Sobotka (https://github.com/sobotka/AgX), as Benjamin Wrensch's minimal implementation has it
// ("Minimal AgX Implementation", 2023, https://iolite-engine.com/blog_posts/minimal_agx_implementation): an
// inset matrix, log2 between two bounds, a polynomial fit of the default contrast, and the outset matrix. The
// result is encoded for the display already. Columns of the matrices one after another.
#define LIMPID_AGX_INSET                                                                              \
    0.842479062253094, 0.0423282422610123, 0.0423756549057051, 0.0784335999999992, 0.878468636469772, \
        0.0784336, 0.0792237451477643, 0.0791661274605434, 0.879142973793104
#define LIMPID_AGX_OUTSET                                                                              \
    1.19687900512017, -0.0528968517574562, -0.0529716355144438, -0.0980208811401368, 1.15190312990417, \
        -0.0980434501171241, -0.0990297440797205, -0.0989611768448433, 1.15107367264116
const float agxMinStops = -12.47393f;
const float agxMaxStops = 4.026069f;
/// Of x^6, x^5, ... 1.
#define LIMPID_AGX_CONTRAST 15.5f, -40.14f, 31.96f, -6.868f, 0.4298f, 0.1191f, -0.00232f

// False colour: luminance relative to filmicKey in stops, rounded, from -6 to +6; encoded for the display.
const int falseColorStops = 6;
#define LIMPID_FALSE_COLORS                                                              \
    vec3(0.05f, 0.00f, 0.10f), vec3(0.20f, 0.05f, 0.38f), vec3(0.22f, 0.12f, 0.65f),     \
        vec3(0.10f, 0.28f, 0.88f), vec3(0.05f, 0.52f, 0.88f), vec3(0.10f, 0.66f, 0.55f), \
        vec3(0.50f, 0.50f, 0.50f), vec3(0.36f, 0.74f, 0.22f), vec3(0.76f, 0.85f, 0.12f), \
        vec3(1.00f, 0.76f, 0.06f), vec3(1.00f, 0.46f, 0.06f), vec3(0.90f, 0.12f, 0.12f), \
        vec3(1.00f, 1.00f, 1.00f)

#endif
