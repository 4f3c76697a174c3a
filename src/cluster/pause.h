// Waiting for messages without spinning, which would take a core from a renderer that runs on it.
#pragma once

#include <algorithm>
#include <chrono>
#include <thread>

namespace limpid::cluster {

/// Waits between two looks for a message: 50 microseconds at first and after reset(), then twice as long each
/// time, up to 2 ms. So a message that comes soon is found soon, and a long wait takes hardly any processor
/// time.
class Pause {
  public:
    void reset() { time_ = first; }
    void operator()() {
        std::this_thread::sleep_for(time_);
        time_ = std::min(time_ * 2, longest);
    }

  private:
    static constexpr std::chrono::microseconds first{50}, longest{2000};
    std::chrono::microseconds time_ = first;
};

}  // namespace limpid::cluster
