// The other side of the split screen: what the picture is compared with, and how far it is from it.
#pragma once

#include <chrono>

#include "studio/background/networks.h"
#include "studio/live/live_render.h"
#include "studio/state/state.h"

namespace limpid::studio {

/// The settings of what a picture made by `main` is compared with.
RenderSettings settingsOfComparison(const State& state, const RenderSettings& main, const Networks& networks);

class LiveComparison {
  public:
    /// All outlive this.
    LiveComparison(gpu::Device& device, const gpu::ShaderReplacements& shaders, const Networks& networks)
        : other_(device, shaders), networks_(networks) {}

    /// As LiveRender has it.
    void setInterruption(std::function<bool()> interrupted) {
        other_.setInterruption(std::move(interrupted));
    }
    /// Before the scene goes, to start anew, or because nothing is compared any more.
    void drop();
    /// Something is another than it was.
    void noteChange() { other_.noteChange(); }
    /// Whether a frame of it is wanted. `moved`: something of the scene has.
    bool mustRender(const State& state, const RenderSettings& main, const CameraParams& camera,
                    bool moved) const;
    /// `alone`: the picture rests, and numbers no frames.
    void render(Stage& stage, const State& state, const RenderSettings& main, Moment moment, bool alone);
    /// Nothing is rendered: the network that it needs is not there yet.
    void setWaiting(bool waits) { waits_ = waits; }
    /// For the next update().
    void setLook(const Look& look) { look_ = look; }
    /// Exposes it as the picture, and scores the picture against it: now and then while frames are rendered,
    /// and the last ones.
    void update(LiveRender& main, float exposure, bool rendering);
    bool isScoring() const { return scores_.busy(); }
    /// Whether there are scores that there were not at the last call.
    bool hasScored() { return scores_.finish(); }

    /// What to show; null if there is nothing.
    LiveRender* picture() { return other_ ? &other_ : nullptr; }
    const std::string& name() const { return name_; }
    const std::string& scores() const { return scores_.text(); }
    const Track& errors() const { return scores_.errors(); }

  private:
    LiveRender other_;
    LiveScores scores_;
    std::string choice_, name_;
    const Networks& networks_;
    uint64_t frames_ = 0;                           ///< ever
    std::tuple<uint64_t, uint64_t, float> scored_;  ///< both numbers of frames and the exposure, of the last
    std::chrono::steady_clock::time_point lastScores_{};
    Look look_;
    bool waits_ = false;
};

}  // namespace limpid::studio
