// A renderer on a thread of its own, with its device.
#pragma once

#include <memory>

#include "studio/session.h"
#include "studio/settings.h"

namespace limpid::studio {

class Studio final : public Session {
  public:
    /// Returns at once; the thread opens the device and loads the scene.
    Studio(gpu::DeviceOptions device, TracerChoice tracer, SceneLoader load, CameraStart start,
           StudioSettings settings);
    /// Ends the thread, after the frame that it computes.
    ~Studio() override;

    uint64_t edit(nlohmann::json changes) override;
    uint64_t steer(const Gesture& gesture) override;
    uint64_t ask(Request request) override;
    std::shared_ptr<const Shown> shown() const override;
    uint64_t addListener(std::function<void()> onShown) override;
    void removeListener(uint64_t listener) override;

    /// The thread has ended by itself: after StudioSettings::quitAfter frames, or because of an error.
    bool hasEnded() const;
    /// Ends the thread, and throws what ended it: what the loader threw for the first scene; Error without a
    /// usable device, and if the validation layer has reported something.
    void finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::studio
