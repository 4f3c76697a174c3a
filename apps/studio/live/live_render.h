// A picture that is rendered on and on: one integrator, denoiser and settings, frame after frame.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "image/tone_curve.h"
#include "renderer/frame/frame_renderer.h"
#include "studio/live/picture_copy.h"
#include "studio/live/stage.h"
#include "studio/picture.h"

namespace limpid::studio {

/// How radiance becomes a picture, beside its exposure.
struct Look {
    image::ToneCurve curve = image::ToneCurve::Standard;
    /// ToneCurve::None is not clipped at 1 (Picture::extended). The other curves end there anyway.
    bool extended = false;
    bool isExtended() const { return extended && curve == image::ToneCurve::None; }
    bool operator==(const Look&) const = default;
};

class LiveRender {
  public:
    /// Both outlive this.
    LiveRender(gpu::Device& device, const gpu::ShaderReplacements& shaders)
        : device_(device), shaders_(shaders) {}

    /// Lets render() throw gpu::Interrupted; then drop() must be called.
    void setInterruption(std::function<bool()> interrupted) { interrupted_ = std::move(interrupted); }
    /// Before the scene goes, or to start anew.
    void drop() { renderer_.reset(); }
    /// It has rendered a frame since.
    explicit operator bool() const { return renderer_ && shown_; }

    /// For the frames to come. True if nothing is known of frames before: they are the first.
    bool prepare(Stage& stage, const RenderSettings& settings, uint32_t samples, float exposure);
    /// The first frame that would be rendered so, recorded only (FrameRenderer::plan()).
    std::unique_ptr<FrameRenderer> plan(Stage& stage, const RenderSettings& settings, uint32_t samples,
                                        const Look& look, Moment moment);
    /// Whether frames rendered so from here would differ from the last one by more than their noise.
    bool differs(const RenderSettings& settings, uint32_t samples) const;
    /// A mean that starts anew starts with the first random numbers, so that it can be made again; `moment`
    /// numbers the frames of pipelines that denoise.
    /// Does not wait for the device.
    void render(Moment moment);
    /// The same for a picture with motion blur: each sample is a launch of its own, which shows the moment
    /// that `at` returns for its number. `camera`: at the frame's time. `anew`: the mean begins anew, as it
    /// does with another camera or other settings.
    void renderBlurred(const CameraParams& camera, bool anew, const std::function<Moment(uint64_t)>& at);
    /// Something is another than it was: samples() of pipelines that denoise count from here.
    void noteChange() { framesOfSame_ = 0; }
    uint64_t framesOfSame() const { return framesOfSame_; }
    uint64_t frames() const { return frames_; }  ///< ever

    /// Per pixel: in the mean, or in the frames since noteChange().
    uint64_t samples() const;
    bool accumulates() const { return settings_.pipeline.accumulates(); }
    const RenderSettings& settings() const { return settings_; }
    const CameraParams& camera() const { return camera_; }
    FrameRenderer& renderer() { return *renderer_; }
    /// For frames to come: whether their denoiser also tells why it kept or rejected histories.
    void setReasons(bool wanted) { reasons_ = wanted; }
    /// The last frame does not tell it, but another one would.
    bool lacksReasons() const {
        return *this && !hasReasons_ && settings_.pipeline.denoiser && !settings_.pipeline.usesNetwork();
    }
    /// For frames to come, and for the next expose().
    void setLook(const Look& look) { nextLook_ = look; }
    /// Exposes the last frame differently, without rendering it again. Waits for the device. Returns false if
    /// it was exposed so already.
    bool expose(float stops);
    /// The last frame, exposed and encoded. Waits for the device.
    std::shared_ptr<const Picture> picture();
    /// The last frame on its way to the host: it stays the same when further frames are rendered. Null: its
    /// picture is there already.
    std::shared_ptr<PictureCopy> underWay() const { return picture_ ? nullptr : copies_[copy_]; }
    /// Changes with the picture.
    uint64_t version() const { return version_; }

  private:
    void noteFrame();
    void startCopy();

    gpu::Device& device_;
    const gpu::ShaderReplacements& shaders_;
    std::function<bool()> interrupted_;
    std::optional<FrameRenderer> renderer_;
    RenderSettings settings_;  ///< of the last frame
    RenderSettings next_;
    uint32_t samples_ = 1;
    float exposure_ = 0.0f;
    Look look_, nextLook_;
    /// Of the last frame and the one before it. Copies that somebody still holds are not used again.
    std::array<std::shared_ptr<PictureCopy>, 2> copies_;
    size_t copy_ = 0;                         ///< index of the last frame's
    std::shared_ptr<const Picture> picture_;  ///< of the last frame; null: nobody has asked for it yet
    CameraParams camera_{};
    bool shown_ = false;
    bool blurred_ = false;  ///< the last frame was
    bool reasons_ = false, hasReasons_ = false;
    uint64_t launches_ = 0;  ///< of the mean
    uint64_t framesOfSame_ = 0;
    uint64_t frames_ = 0;
    uint64_t version_ = 0;
};

}  // namespace limpid::studio
