// When the next picture of a stream is sent.
#pragma once

#include <chrono>

namespace limpid::serve {

/// Keeps to a rate on average, and sends pictures while they are new. With fixed ticks, pictures of a
/// renderer that has another rate would wait for the next tick, up to a period long. So a new picture may be
/// sent up to half a period before its tick. One that comes still earlier is left out, unless nothing newer
/// comes until half a period after the tick. After a pause the ticks begin anew: no pictures catch up.
class Pace {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::nanoseconds period{1'000'000'000 / 60};  ///< between two pictures
    static constexpr std::chrono::nanoseconds slack = period / 2;

    /// `isNew`: the picture has just come.
    bool isDue(Clock::time_point now, bool isNew) const { return now >= (isNew ? tick_ - slack : latest()); }
    /// From then on a picture is due that is not new.
    Clock::time_point latest() const { return tick_ + slack; }
    /// A picture is sent.
    void note(Clock::time_point now) { tick_ = (now - tick_ < period ? tick_ : now) + period; }

  private:
    Clock::time_point tick_{};
};

}  // namespace limpid::serve
