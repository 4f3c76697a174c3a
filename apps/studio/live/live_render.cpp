#include "studio/live/live_render.h"

#include "image/io/png/png.h"
#include "image/tonemap.h"
#include "passes/tonemap/tonemap.h"

namespace limpid::studio {
namespace {

gpu::ImageHandle display(gpu::FrameGraph& graph, const FrameImages& images, float exposure,
                         const Look& look) {
    const gpu::ImageHandle radiance = images.beauty ? images.beauty : images.diffuse,
                           added = images.beauty ? gpu::ImageHandle{} : images.emission;
    if (look.isExtended()) return tonemapExtended(graph, radiance, exposure, added);
    return tonemap(graph, radiance, exposure, added, look.curve);
}

}  // namespace

bool LiveRender::prepare(Stage& stage, const RenderSettings& settings, uint32_t samples, float exposure) {
    exposure_ = exposure;
    look_ = nextLook_;
    if (renderer_ && samples == samples_) {
        const bool anew = renderer_->setSettings(settings);
        next_ = settings;
        return anew;
    }
    renderer_.emplace(device_, stage.onDevice(), settings, samples);
    renderer_->graph().setReplacements(&shaders_);
    renderer_->graph().setInterruption(interrupted_);
    renderer_->setDisplay([this](gpu::FrameGraph& graph, const FrameImages& images) {
        return display(graph, images, exposure_, look_);
    });
    next_ = settings;
    samples_ = samples;
    launches_ = framesOfSame_ = 0;
    shown_ = false;
    return true;
}

std::unique_ptr<FrameRenderer> LiveRender::plan(Stage& stage, const RenderSettings& settings,
                                                uint32_t samples, const Look& look, Moment moment) {
    auto planned = std::make_unique<FrameRenderer>(device_, stage.onDevice(), settings, samples);
    planned->graph().setReplacements(&shaders_);
    planned->setDisplay([look](gpu::FrameGraph& graph, const FrameImages& images) {
        return display(graph, images, 0.0f, look);
    });
    planned->plan(std::move(moment));
    return planned;
}

bool LiveRender::differs(const RenderSettings& settings, uint32_t samples) const {
    if (!*this || samples != samples_) return true;
    if (!settings.pipeline.accumulates()) return settings != settings_;
    return mustReset({camera_, settings_}, {camera_, settings});
}

void LiveRender::render(Moment moment) {
    if (next_.pipeline.accumulates()) {
        if (blurred_) renderer_->restart();
        if (blurred_ || moment.scene || mustReset({camera_, settings_}, {moment.camera, next_}))
            launches_ = 0;
        moment.number = launches_++;
    }
    settings_ = next_;
    camera_ = moment.camera;
    blurred_ = false;
    renderer_->setReasons(reasons_);
    renderer_->render(std::move(moment));
    noteFrame();
}

void LiveRender::renderBlurred(const CameraParams& camera, bool anew,
                               const std::function<Moment(uint64_t)>& at) {
    if (anew || !blurred_ || mustReset({camera_, settings_}, {camera, next_})) {
        renderer_->restart();
        launches_ = 0;
    }
    settings_ = next_;
    camera_ = camera;
    blurred_ = true;
    renderer_->setReasons(reasons_);
    for (uint32_t sample = 0; sample < samples_; ++sample) {
        renderer_->moveOn(at(launches_));
        const uint64_t number = launches_++;
        renderer_->launch({.stream = number, .first = number, .point = number});
    }
    noteFrame();
}

void LiveRender::noteFrame() {
    hasReasons_ = reasons_;
    startCopy();
    ++version_;
    shown_ = true;
    ++framesOfSame_;
    ++frames_;
}

void LiveRender::startCopy() {
    picture_.reset();
    copy_ = 1 - copy_;
    std::shared_ptr<PictureCopy>& copy = copies_[copy_];
    if (!copy || copy.use_count() > 1) copy = std::make_shared<PictureCopy>(device_);
    copy->start(renderer_->graph(), renderer_->displayed());
}

uint64_t LiveRender::samples() const {
    if (!*this) return 0;
    return accumulates() ? renderer_->samplesInMean() : framesOfSame_ * samples_;
}

bool LiveRender::expose(float stops) {
    if (stops == exposure_ && look_ == nextLook_) return false;
    exposure_ = stops;
    look_ = nextLook_;
    const image::Image beauty = beautyOf(renderer_->download());
    Picture picture{.extent = {beauty.width, beauty.height}, .texels = {}};
    if (look_.isExtended())
        picture.extended = extendedTexels(beauty, stops);
    else
        picture.texels = packedTexels(image::toBytes(image::tonemap(beauty, stops, look_.curve)));
    picture_ = std::make_shared<const Picture>(std::move(picture));
    ++version_;
    return true;
}

std::shared_ptr<const Picture> LiveRender::picture() {
    if (!picture_) picture_ = copies_[copy_]->picture();
    return picture_;
}

}  // namespace limpid::studio
