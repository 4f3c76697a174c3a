// The frames: whether to render one, rendering it, its times and exposure, and changed shaders.
#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <utility>

#include "base/freed_memory.h"
#include "image/tonemap.h"
#include "renderer/frame/reset_rule.h"
#include "renderer/sequence/sequence.h"
#include "scene/model/camera.h"
#include "studio/background/priority.h"
#include "studio/loop/render_loop.h"

namespace limpid::studio {
namespace {

constexpr double betweenTimes = 0.25;   ///< seconds between reads of the passes' times
constexpr double betweenSources = 0.5;  ///< seconds between checks of the shaders' files
constexpr int previewDivisor = 4;       ///< of the viewport's sides, on CPUs
constexpr double settleSeconds = 0.3;   ///< without a change, after which nothing counts as moving

}  // namespace

CameraParams RenderLoop::cameraAt(double time) const {
    return scene::cameraParams(rig_.at(*stage_, time), wanted_.extent.width, wanted_.extent.height);
}

/// The shutter of the next frame; closed if it has no motion blur. A comparison would see the scene at the
/// instant that it stands at, and frames that follow a movement would each show one instant only.
Shutter RenderLoop::blur() const {
    const Pipeline& pipeline = wanted_.pipeline;
    const bool moves = stage_->moves() || rig_.movesOnPath();
    const bool can = pipeline.accumulates() && !pipeline.takesOneSampleALaunch();
    const bool rests = !other_ && !playback_.playing && !state_.comparison.isOn();
    return state_.shutter.isOpen() && moves && can && rests ? state_.shutter : Shutter{};
}

/// Returns true if the next picture would differ from the last one, apart from noise. `camera`: with the last
/// one's extent.
bool RenderLoop::isOther(const CameraParams& camera) const {
    return main_.differs(wanted_, state_.samples) || stage_->lightsChanged() ||
           (state_.running && (!sameCamera(camera, main_.camera()) ||
                               (stage_->moves() && playback_.change()) || playback_.playing));
}

/// Chooses the extent of the next frame. Returns true if that frame should be rendered.
bool RenderLoop::mustRender() {
    if (state_.viewport.width == 0 || state_.viewport.height == 0) return false;
    const std::tuple work{wanted_.pipeline, state_.samples, state_.comparison.isOn(), facts_.scenesShown};
    if (std::exchange(work_, work) != work) resolution_.forget();
    if (main_) wanted_.extent = main_.settings().extent;
    other_ = !main_ || isOther(cameraNow());
    const bool switchesBlur = state_.running && blur() != blurOfLast_;
    const auto now = Clock::now();
    if (other_) changed_ = now;
    const bool moves = std::chrono::duration<double>(now - changed_).count() < settleSeconds;
    // The compiler needs the cores of a CPU more than the preview that stands in for the first frame.
    const bool rough = isNew_ && device_.isCpu() && state_.resolution == Resolution::Automatic;
    wanted_.extent = rough ? divided(state_.viewport, previewDivisor)
                           : resolution_.choose(state_.viewport, state_.resolution, moves);
    interruptible_ = !moves && resolution_.takesLong(uint64_t{wanted_.extent.width} * wanted_.extent.height);
    const bool resized = main_ && wanted_.extent != main_.settings().extent;
    const bool anew = other_ || resized || switchesBlur;
    if (anew) {
        main_.noteChange();
        comparison_.noteChange();
    }
    if (std::exchange(step_, false) || anew) return true;
    if (state_.running && wantsReasons() && main_.lacksReasons()) return true;
    // Nothing is known of the device's speed yet: the coarse picture is not the last one.
    const bool unmeasured = !isNew_ && !moves && resolution_.isCoarse();
    return state_.running && (unmeasured || settings_.quitAfter > 0 ||
                              main_.samples() < (isNew_ ? 1u : static_cast<uint64_t>(state_.maxSamples)));
}

/// Whether the preview stands in for the first frame of a scene. Compiles what that needs meanwhile.
bool RenderLoop::previewsFirst() {
    if (compiling_.valid()) {
        if (compiling_.wait_for(std::chrono::seconds(0)) != std::future_status::ready && !ending_)
            return true;
        try {
            compiling_.get();
        } catch (const gpu::DeviceLost&) {
            throw;
        } catch (const Error& fault) {  // the frame that needs them will fail, and tell the user
            log::warn("{}", fault.what());
            return false;
        }
    }
    // A given number of frames is for scripts, which want the same pictures each time.
    const bool hasPixels = state_.viewport.width > 0 && state_.viewport.height > 0;
    if (settings_.quitAfter > 0 || ending_ || !hasPixels ||
        wanted_.pipeline.integrator == Integrator::Preview)
        return false;
    wanted_.extent = state_.viewport;
    std::shared_ptr<FrameRenderer> first =
        main_.plan(*stage_, wanted_, state_.samples, lookOf(wanted_.pipeline), {.camera = cameraNow()});
    if (first->graph().isPrepared(device_)) return false;
    compiling_ = std::async(std::launch::async, [this, first = std::move(first)] {
        lowerPriorityBelowFrames();
        first->graph().prepareBeside(device_);
    });
    return true;
}

/// Renders the next frame, or another one of the comparison alone. Returns false if neither is needed.
bool RenderLoop::renderWhatIsDue() {
    applySettings();
    if (hasFailed_ && !ending_) return false;
    try {
        return renderNext();
    } catch (const gpu::Interrupted&) {
        playback_.reset(playback_.time());
        main_.drop();
        comparison_.drop();
        return true;
    } catch (const gpu::DeviceLost&) {
        throw;
    } catch (const Error& fault) {
        // With a given number of frames, and for a picture that is saved on leaving, nobody could try again.
        if (settings_.quitAfter > 0 || ending_) throw;
        return goBack(fault.what());
    }
}

bool RenderLoop::renderNext() {
    const bool wasNew = std::exchange(isNew_, isNew_ && previewsFirst());
    if (wasNew && !isNew_) {
        publishWaiting();  // the preview: the method's first frame takes longer
        flight_.reset(playback_.time());
    }
    if (isNew_) {
        wanted_.pipeline = {Integrator::Preview};
        wanted_.jitter = defaultJitter(wanted_.pipeline);
        networks_.set(wanted_);
        comparison_.setWaiting(true);
    }
    const bool main = mustRender();
    comparison_.setLook({state_.toneCurve, settings_.extended});
    if (wanted_.extent.width == 0 || wanted_.extent.height == 0) return false;
    const CameraParams camera = cameraNow();
    const bool other =
        !main && main_ && state_.running && comparison_.mustRender(state_, wanted_, camera, false);
    const bool news = !facts_.computing || !main_ || wanted_.extent != main_.settings().extent;
    if (main) ++facts_.framesBegun;
    if (main && news) announce();
    if (main) renderTimed(camera);
    if (other) comparison_.render(*stage_, state_, wanted_, playback_.moment(camera), true);
    measureExposure();
    if (main_) main_.setLook(lookOf(main_.settings().pipeline));
    if (main_ && main_.expose(stopsOf(main_.settings().pipeline))) changedFacts_ = true;
    noteFrameTime(main);
    comparison_.update(main_, state_.exposure, main || other);
    saveWhatIsAsked();
    // What stands in for the picture that is wanted says nothing of whether that can be rendered.
    if ((main || other) && !isNew_ && !networks_.isLoading() && !resolution_.isCoarse()) rendered_ = state_;
    return main || other;
}

/// After a frame that could not be rendered, say because the device's memory does not suffice: goes back to
/// the method of the last frame that could, or stops until something changes. Returns true if another frame
/// is to be rendered.
bool RenderLoop::goBack(const std::string& fault) {
    const std::optional<State> before = std::exchange(rendered_, std::nullopt);
    begun_.reset();
    probeAt_.reset();
    isNew_ = false;
    startAnew();
    stage_->repeatLights();
    changedFacts_ = true;
    facts_.fault = fault + (before ? "; the settings before are used again" : "; rendering is stopped");
    log::warn("{}", facts_.fault);
    if (!before) {
        state_.running = false;
        hasFailed_ = true;
        return false;
    }
    // The viewport stays: the window would set it again at once. So do the camera and the lights.
    state_.render = before->render;
    state_.pipelineBefore = before->pipelineBefore;
    state_.parts = before->parts;
    state_.samples = before->samples;
    state_.jitter = before->jitter;
    state_.resolution = before->resolution;
    state_.comparison = before->comparison;
    state_.arrows = before->arrows;
    state_.pass = before->pass;
    state_.shutter = before->shutter;
    return true;
}

void RenderLoop::renderTimed(const CameraParams& camera) {
    Begun frame{.copy = nullptr, .when = Clock::now(), .pipelines = device_.pipelineCount()};
    render(camera);
    frame.copy = main_.underWay();
    begun_ = std::move(frame);
    if (!overlaps()) awaitFrame();
}

/// Whether the picture of a frame is brought to the host while the next one is computed.
bool RenderLoop::overlaps() const {
    return settings_.overlaps.value_or(!device_.isCpu());
}

/// Waits until the device has finished the frame that was begun last, and notes its times.
void RenderLoop::awaitFrame() {
    if (!begun_) return;
    const Begun frame = *std::exchange(begun_, std::nullopt);
    frame.copy->wait();
    const double seconds = secondsSince(frame.when);
    facts_.renderMilliseconds = seconds * 1e3;
    // A frame that had to compile shaders says nothing of the others.
    const gpu::Extent extent = main_.settings().extent;
    const size_t pipelines = device_.pipelineCount();
    if (pipelines == frame.pipelines) resolution_.note(uint64_t{extent.width} * extent.height, seconds);
    if (device_.isCpu() && pipelines != pipelinesBefore_) returnFreedMemory();  // of the driver's compiler
    pipelinesBefore_ = pipelines;
    if (!due(lastTimes_, betweenTimes)) return;
    facts_.timings.addPasses(main_.renderer().passTimes());
    facts_.memoryBytes = device_.allocatedBytes();
    facts_.sceneBytes = stage_->onDevice().byteCount();
}

void RenderLoop::render(const CameraParams& camera) {
    if (settings_.loseDeviceAt > 0 && rendered() == settings_.loseDeviceAt)
        throw gpu::DeviceLost("the device is taken for lost");
    const bool changed = main_ && (wanted_ != main_.settings() || state_.fovDegrees != fovOfLast_);
    main_.setLook(lookOf(wanted_.pipeline));
    if (main_.prepare(*stage_, wanted_, state_.samples, stopsOf(wanted_.pipeline)))
        playback_.reset(playback_.time());
    else if (changed)
        playback_.noteOtherSettings();
    if (stage_->lightsChanged()) playback_.noteOtherSettings();
    // A blurred frame leaves the scene at one of its instants.
    const Shutter shutter = blur();
    if (std::exchange(blurOfLast_, shutter) != shutter) playback_.seek(playback_.time());
    main_.setReasons(wantsReasons());
    if (shutter.isOpen())
        renderBlurred(camera);
    else
        renderSharp(camera);
    fovOfLast_ = state_.fovDegrees;
    playback_.advance(camera, rig_.key());
    flight_.playing = playback_.playing;
    flight_.advance(camera, rig_.key());
    facts_.samplesInMean = main_.accumulates() ? main_.samples() : 0;
    facts_.frames = playback_.frames();
}

void RenderLoop::renderSharp(const CameraParams& camera) {
    Moment moment = playback_.moment(camera);
    std::optional<Stage::Step> step;
    if (const auto change = playback_.change(); change && stage_->moves())
        step = Stage::Step{change->from, change->to};
    moment.scene = stage_->nextFrame(step, playback_.shownTime());
    if (comparison_.mustRender(state_, wanted_, camera, moment.scene.has_value()))
        comparison_.render(*stage_, state_, wanted_, moment, false);
    main_.render(std::move(moment));
}

/// Each sample sees the scene and the camera at another instant of the open shutter.
void RenderLoop::renderBlurred(const CameraParams& camera) {
    const SequenceTiming timing{.framesPerSecond = playback_.framesPerSecond, .shutter = blurOfLast_};
    const double time = playback_.time();
    const bool anew = stage_->lightsChanged() || playback_.change();
    main_.renderBlurred(camera, anew, [&](uint64_t launch) {
        const double instant = shutterInstant(wanted_.seed, 0, launch);
        const double then = time + offsetDuring(timing, rig_.path(), time, instant);
        std::optional<Stage::Step> step;
        if (stage_->moves()) step = Stage::Step{then, then};
        return Moment{.camera = cameraAt(then), .scene = stage_->nextFrame(step, then)};
    });
}

void RenderLoop::noteFrameTime(bool rendered) {
    const auto now = Clock::now();
    if (rendered && frameBefore_)
        facts_.timings.addFrame(std::chrono::duration<double, std::milli>(now - lastFrame_).count());
    lastFrame_ = now;
    frameBefore_ = rendered;
}

/// Measures the exposure once there is a picture that uses one.
void RenderLoop::measureExposure() {
    if (!measureExposure_ || !main_ || !main_.settings().pipeline.needsExposure()) return;
    measureExposure_ = false;
    const RenderedLayers layers = main_.renderer().download();
    state_.exposure = image::autoExposure(beautyOf(layers), surfaceShare(layers));
}

/// Returns the exposure for this pipeline; 0 if its picture is not radiance.
float RenderLoop::stopsOf(const Pipeline& pipeline) const {
    return pipeline.needsExposure() ? state_.exposure : 0.0f;
}

/// The same for the tone curve.
image::ToneCurve RenderLoop::curveOf(const Pipeline& pipeline) const {
    return pipeline.needsExposure() ? state_.toneCurve : image::ToneCurve::Standard;
}

Look RenderLoop::lookOf(const Pipeline& pipeline) const {
    return {curveOf(pipeline), settings_.extended};
}

/// Recompiles changed shaders. Returns true if there were any.
bool RenderLoop::reloadShaders() {
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

}  // namespace limpid::studio
