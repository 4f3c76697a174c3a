// A session without a renderer, for tests: edits apply at once, and its pictures are given to it.
#pragma once

#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "base/error.h"
#include "studio/loop/mailbox.h"
#include "studio/session.h"
#include "studio/state/state_json.h"

namespace limpid::serve {

class FakeSession final : public studio::Session {
  public:
    uint64_t edit(nlohmann::json changes) override {
        return change([&](studio::Shown& next) {
            try {
                studio::apply(next.state, changes);
            } catch (const UsageError& fault) {
                next.facts.fault = fault.what();
            }
        });
    }
    uint64_t steer(const studio::Gesture& gesture) override {
        return change([&](studio::Shown& next) { next.state.pose.eye.x += gesture.orbit.x; });
    }
    uint64_t ask(studio::Request request) override {
        return change([&](studio::Shown&) { asked_.push_back(std::move(request)); });
    }
    std::shared_ptr<const studio::Shown> shown() const override { return mailbox_.shown(); }
    uint64_t addListener(std::function<void()> listener) override {
        return mailbox_.addListener(std::move(listener));
    }
    void removeListener(uint64_t number) override { mailbox_.removeListener(number); }

    /// Publishes the next snapshot: the last one, changed by the function.
    template <typename Function>
    void publish(Function function) {
        const std::lock_guard lock(mutex_);
        auto next = std::make_shared<studio::Shown>(*mailbox_.shown());
        ++next->number;
        function(*next);
        mailbox_.publish(std::move(next));
    }
    /// Shows a picture. `computing`: false: it is the last one for now.
    void show(studio::Picture picture, bool computing,
              std::shared_ptr<const studio::Picture> compared = nullptr) {
        publish([&](studio::Shown& next) {
            next.facts.computing = computing;
            next.state.viewport = picture.extent;
            next.picture = std::make_shared<const studio::Picture>(std::move(picture));
            next.compared = std::move(compared);
        });
    }
    /// Messages are not said to be handled until the first one after it.
    std::atomic<bool> busy = false;
    std::vector<studio::Request> asked() const {
        const std::lock_guard lock(mutex_);
        return asked_;
    }

  private:
    template <typename Function>
    uint64_t change(Function function) {
        uint64_t number = 0;
        publish([&](studio::Shown& next) {
            number = ++messages_;
            function(next);
            if (!busy) next.messages = messages_;
        });
        return number;
    }

    studio::Mailbox mailbox_;
    mutable std::mutex mutex_;
    uint64_t messages_ = 0;
    std::vector<studio::Request> asked_;
};

}  // namespace limpid::serve
