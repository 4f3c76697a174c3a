// Parameters of temporal accumulation. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_TEMPORAL_PARAMS_H
#define LIMPID_DENOISE_TEMPORAL_PARAMS_H

#include "denoise/stages/reproject/reproject_params.h"
#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

// Values of the image `temporal/disocclusion`: why a pixel has no history. SAMPLE_REJECTED is a bit that is
// added if the pixel's sample was rejected.
LIMPID_CONST uint DISOCCLUSION_NONE = 0u;
LIMPID_CONST uint DISOCCLUSION_NOTHING_HIT = 1u;
LIMPID_CONST uint DISOCCLUSION_OFF_SCREEN = 2u;  // or behind the previous eye, or there is no previous frame
LIMPID_CONST uint DISOCCLUSION_NO_VALID_TAP = 3u;
LIMPID_CONST uint DISOCCLUSION_MASK = 3u;
LIMPID_CONST uint SAMPLE_REJECTED = 4u;

/// For the debug view that shows the causes of disocclusion.
struct TemporalShowParams {
    uint width;
    uint height;
};

struct TemporalParams {
    CameraParams camera;
    uint width;
    uint height;
    ReprojectTests tests;
    uint identity;    // 0: instances are not compared
    float minAlbedo;  // 0: means are resampled without demodulation
    uint greyRestart;
    uint greyMisses;
    float grey;        // cd/m^2
    float maxHistory;  // frames; infinite: no limit
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
