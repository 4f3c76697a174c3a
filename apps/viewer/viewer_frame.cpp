// The frames in the window: whether to render one, rendering it, its times and exposure, and changed shaders.
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <utility>

#include "image/tonemap.h"
#include "renderer/frame/reset_rule.h"
#include "scene/model/camera.h"
#include "viewer_session.h"

namespace limpid::viewer {
namespace {

constexpr double betweenTimes = 0.25;   ///< seconds between reads of the passes' times, which wait for the
                                        ///< device
constexpr double betweenSources = 0.5;  ///< seconds between checks of the shaders' files

}  // namespace

CameraParams Viewer::cameraNow() const {
    const gpu::Extent extent = panel_.render.extent;
    return scene::cameraParams(rig_.at(*stage_, playback_.time()), extent.width, extent.height);
}

/// Returns true if the next picture would differ from the last one and should be rendered.
bool Viewer::mustRender(const CameraParams& camera) {
    const gpu::Extent extent = panel_.render.extent;
    if (extent.width == 0 || extent.height == 0) return false;
    if (std::exchange(panel_.asked.step, false)) return true;
    bool changed = main_.differs(panel_.render, panel_.samples) || stage_->lightsChanged();
    if (!changed && !panel_.running) return false;
    changed = changed || !sameCamera(camera, main_.camera()) || (stage_->moves() && playback_.change()) ||
              playback_.playing;
    if (changed) {
        main_.noteChange();
        comparison_.noteChange();
    }
    return changed || settings_.quitAfter > 0 || main_.samples() < static_cast<uint64_t>(panel_.maxSamples);
}

void Viewer::render(const CameraParams& camera) {
    if (settings_.loseDeviceAt > 0 && rendered() == settings_.loseDeviceAt)
        throw gpu::DeviceLost("the device is taken for lost");
    const bool changed = main_ && (panel_.render != main_.settings() || panel_.fovDegrees != fovOfLast_);
    if (main_.prepare(*stage_, panel_.render, panel_.samples, stopsOf(panel_.render.pipeline)))
        playback_.reset(playback_.time());
    else if (changed)
        playback_.noteOtherSettings();
    Moment moment = playback_.moment(camera);
    if (stage_->lightsChanged()) playback_.noteOtherSettings();
    std::optional<Stage::Step> step;
    if (const auto change = playback_.change(); change && stage_->moves())
        step = Stage::Step{change->from, change->to};
    moment.scene = stage_->nextFrame(step, playback_.shownTime());
    if (comparison_.mustRender(panel_, camera, moment.scene.has_value()))
        comparison_.render(*stage_, panel_, moment, false);
    main_.render(std::move(moment));
    fovOfLast_ = panel_.fovDegrees;
    playback_.advance(camera, rig_.key());
    measureExposure();
    facts_.samplesInMean = main_.accumulates() ? main_.samples() : 0;
    facts_.frames = playback_.frames();
}

void Viewer::noteTimes(bool rendered) {
    const auto now = Clock::now();
    if (rendered && frameBefore_)
        facts_.timings.addFrame(std::chrono::duration<double, std::milli>(now - lastFrame_).count());
    lastFrame_ = now;
    frameBefore_ = rendered;
    if (!rendered || !due(lastTimes_, betweenTimes)) return;
    facts_.timings.addPasses(main_.renderer().passTimes());
    facts_.memoryBytes = device_.allocatedBytes();
    facts_.sceneBytes = stage_->onDevice().byteCount();
}

/// Measures the exposure once there is a picture that uses one.
void Viewer::measureExposure() {
    if (!panel_.asked.measureExposure || !main_ || !main_.settings().pipeline.needsExposure()) return;
    panel_.asked.measureExposure = false;
    const RenderedLayers layers = main_.renderer().download();
    panel_.exposure = image::autoExposure(beautyOf(layers), surfaceShare(layers));
}

/// Returns the exposure for this pipeline; 0 if its picture is not radiance.
float Viewer::stopsOf(const Pipeline& pipeline) const {
    return pipeline.needsExposure() ? panel_.exposure : 0.0f;
}

/// Recompiles changed shaders. Returns true if there were any.
bool Viewer::reloadShaders() {
    if (!reload_.watches() || !main_ || !due(lastSources_, betweenSources)) return false;
    std::vector<gpu::ShaderCode> used = main_.renderer().graph().usedShaders();
    if (LiveRender* const other = comparison_.picture()) {
        const std::vector<gpu::ShaderCode> more = other->renderer().graph().usedShaders();
        used.insert(used.end(), more.begin(), more.end());
    }
    const std::optional<ShaderReload::Result> result = reload_.poll(used);
    if (!result) return false;
    attempt([&] {
        if (!result->fault.empty()) throw Error(result->fault);
        say(fmt::format("compiled {} shaders", result->compiled));
        startAnew();
    });
    return true;
}

}  // namespace limpid::viewer
