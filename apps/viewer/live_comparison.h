// The other side of the split screen: what the picture is compared with, and how far it is from it.
#pragma once

#include <chrono>

#include "live_render.h"
#include "panel.h"

namespace limpid::viewer {

/// Of what the panel's picture is compared with.
RenderSettings settingsOfComparison(const PanelState& panel);

class LiveComparison {
  public:
    /// Both outlive this.
    LiveComparison(gpu::Device& device, const gpu::ShaderReplacements& shaders) : other_(device, shaders) {}

    /// Before the scene goes, to start anew, or because nothing is compared any more.
    void drop();
    /// Something is another than it was.
    void noteChange() { other_.noteChange(); }
    /// Whether a frame of it is wanted. `moved`: something of the scene has; `stepping`: one frame is, though
    /// rendering stands still.
    bool mustRender(const PanelState& panel, const CameraParams& camera, bool moved, bool stepping) const;
    /// `alone`: the picture rests, and numbers no frames.
    void render(Stage& stage, const PanelState& panel, Moment moment, bool alone);
    /// Exposes it as the picture, and scores the picture against it: now and then while frames are rendered,
    /// and the last ones. `wake` is called, from another thread, when there are scores.
    void update(LiveRender& main, float exposure, bool rendering, std::function<void()> wake);

    /// What to show; null if there is nothing.
    LiveRender* picture() { return other_ ? &other_ : nullptr; }
    const std::string& name() const { return name_; }
    const std::string& scores() { return scores_.text(); }

  private:
    LiveRender other_;
    LiveScores scores_;
    std::string name_;
    uint64_t frames_ = 0;                   ///< ever
    std::pair<uint64_t, uint64_t> scored_;  ///< both numbers of frames, of the last scores
    std::chrono::steady_clock::time_point lastScores_{};
};

}  // namespace limpid::viewer
