// What a user of the studio chooses: the scene's view, the method, the look. A value, independent of any
// device.
#pragma once

#include <string>
#include <vector>

#include "image/tone_curve.h"
#include "renderer/method/denoiser_parts.h"
#include "renderer/method/settings.h"
#include "renderer/sequence/shutter.h"
#include "studio/compare/comparison.h"
#include "studio/compare/inspector.h"
#include "studio/state/light_desk.h"

namespace limpid::studio {

/// Position and orientation of the camera that is shown. World units.
struct CameraPose {
    vec3 eye{0.0f}, target{0.0f}, up{0.0f, 1.0f, 0.0f};
    bool operator==(const CameraPose&) const = default;
};

/// How many pixels are rendered for those of the viewport.
enum class Resolution {
    Automatic,  ///< fewer while something moves and the device is slow, else all
    Full,
    Half,     ///< along each axis
    Quarter,  ///< ...
    Eighth,
};

/// State::jitter for this one.
int jitterChoice(Jitter jitter, const Pipeline& pipeline);

struct State {
    gpu::Extent viewport{1280, 720};  ///< pixels in which the picture is shown
    /// Its extent and jitter follow from the fields below; its networks are empty.
    RenderSettings render;
    DenoiserParts parts;    ///< of the chosen denoiser
    uint32_t samples = 1;   ///< per pixel and frame
    int maxSamples = 4096;  ///< per pixel; then a picture in which nothing changes is finished
    int jitter = 0;         ///< 0: as the pipeline needs it; else 1 + Jitter
    Resolution resolution = Resolution::Automatic;
    float exposure = 0.0f;  ///< stops
    float fovDegrees = 45.0f;
    float halfHeight = 0.0f;  ///< of what an orthographic camera sees, world units; 0: with perspective
    int camera = 0;           ///< index into Facts::cameras
    CameraPose pose;          ///< changing it, or halfHeight, makes the camera free
    bool running = true;      ///< frames are rendered as long as they improve the picture
    bool playing = false;     ///< the clip, or the camera's path
    float time = 0.0f;        ///< seconds
    Shutter shutter;          ///< of a picture that rests (RenderLoop::blur())
    std::string pass;         ///< pass whose images are shown instead of the picture; empty: none
    int image = 0;            ///< index into Facts::images
    InspectorView view;
    ComparisonChoice comparison;
    bool arrows = false;  ///< the motion is downloaded, for arrows
    LightDesk lights;
    image::ToneCurve toneCurve = image::ToneCurve::Standard;
    Pipeline pipelineBefore;  ///< that of before the preview

    bool isPreview() const { return render.pipeline.integrator == Integrator::Preview; }
    /// Selects the integrator `preview`, or the pipeline before it.
    void setPreview(bool on) {
        if (on == isPreview()) return;
        if (on) pipelineBefore = render.pipeline;
        render.pipeline = on ? Pipeline{Integrator::Preview} : pipelineBefore;
    }
};

}  // namespace limpid::studio
