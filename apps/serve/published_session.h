// A session without a renderer, whose snapshots a test publishes.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

#include "studio/loop/mailbox.h"

namespace limpid::serve {

class PublishedSession : public studio::Session {
  public:
    uint64_t edit(nlohmann::json changes) override { return mailbox.post(std::move(changes)); }
    uint64_t steer(const studio::Gesture& gesture) override { return mailbox.post(gesture); }
    uint64_t ask(studio::Request request) override { return mailbox.post(std::move(request)); }
    std::shared_ptr<const studio::Shown> shown() const override { return mailbox.shown(); }
    uint64_t addListener(std::function<void()> f) override { return mailbox.addListener(std::move(f)); }
    void removeListener(uint64_t listener) override { mailbox.removeListener(listener); }

    void publish(const studio::Picture& picture, bool computing,
                 std::shared_ptr<const studio::Picture> compared = nullptr) {
        auto next = std::make_shared<studio::Shown>();
        next->number = ++numbers_;
        next->state.viewport = picture.extent;
        next->picture = std::make_shared<const studio::Picture>(picture);
        next->compared = std::move(compared);
        next->facts.computing = computing;
        mailbox.publish(std::move(next));
    }

    studio::Mailbox mailbox;

  private:
    uint64_t numbers_ = 0;
};

/// Waits at most two seconds, or `seconds`; returns whether it holds.
inline bool soon(const std::function<bool()>& condition, double seconds = 2.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

}  // namespace limpid::serve
