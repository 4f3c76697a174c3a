// Why a pixel's history was kept or rejected: the values of the image that the reasons pass writes, and its
// parameters. Included by C++ and GLSL.
//
// First component of the image: REASON_*, plus REASON_REFLECTED if the history was found along the motion of
// the reflected image, plus for each of the four bilinear taps (row by row) a TAP_* from bit REASON_TAPS +
// REASON_TAP_BITS i on. Second component: the frames of history that the pixel has now, with this one, from 0
// to REASON_MAX_FRAMES, and from bit REASON_WHOLE on those that it would have without anti-lag, or 0 if
// nothing was kept. Both components stay below 2^24, so floats hold them exactly.
#ifndef LIMPID_DENOISE_REASONS_PARAMS_H
#define LIMPID_DENOISE_REASONS_PARAMS_H

#include "denoise/stages/reproject/reproject_params.h"
#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST uint REASON_NOTHING_SEEN = 0u;  // the pixel sees no surface
LIMPID_CONST uint REASON_CUT = 1u;           // there is no previous frame to continue
LIMPID_CONST uint REASON_NO_MOTION =
    2u;  // no valid motion, for example because it was behind the previous eye
LIMPID_CONST uint REASON_OFF_SCREEN = 3u;  // it was outside the previous picture
LIMPID_CONST uint REASON_REJECTED = 4u;    // the taps say why
LIMPID_CONST uint REASON_KEPT = 5u;        // of the taps that are TAP_FITS
LIMPID_CONST uint REASON_SEARCHED = 6u;    // no tap fits, but one of 3x3 pixels around
LIMPID_CONST uint REASON_SHORTENED = 7u;   // kept, but anti-lag removed a part of it
LIMPID_CONST uint REASON_MASK = 7u;
LIMPID_CONST uint REASON_REFLECTED = 8u;
LIMPID_CONST int REASON_TAPS = 4;
LIMPID_CONST int REASON_TAP_BITS = 5;
LIMPID_CONST uint REASON_TAP_MASK = 31u;
LIMPID_CONST int REASON_WHOLE = 12;
LIMPID_CONST uint REASON_MAX_FRAMES = 4095u;

// What is wrong with a tap: a sum of these four, ...
LIMPID_CONST uint TAP_FITS = 0u;
LIMPID_CONST uint TAP_INSTANCE = 1u;  // it shows another instance
LIMPID_CONST uint TAP_NORMAL = 2u;    // its normal differs
LIMPID_CONST uint TAP_DISTANCE = 4u;  // its distance differs
LIMPID_CONST uint TAP_NO_HISTORY =
    8u;  // nothing was accumulated there, for example because its sample was no number
// ... or one of these.
LIMPID_CONST uint TAP_OUTSIDE = 16u;       // outside the previous picture
LIMPID_CONST uint TAP_NOTHING_SEEN = 17u;  // no surface there
LIMPID_CONST uint TAP_LOBE = 18u;    // it fits, but reflects in another direction, for the width of the lobe
LIMPID_CONST uint TAP_LIGHT = 19u;   // it fits, but all taps that do have less than MIN_SHARE of the weight
LIMPID_CONST uint TAP_UNUSED = 20u;  // its bilinear weight is 0

struct ReasonsParams {
    CameraParams camera;
    uint width;
    uint height;
    ReprojectTests tests;
    float lobeScale;  // lobe.glsl
    float longest;    // frames: longer histories count for as many
    uint cut;
    uint shortens;  // anti-lag does, after reprojection
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
