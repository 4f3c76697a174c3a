#include "studio/state/timings.h"

#include <fmt/format.h>

#include <algorithm>

namespace limpid::studio {

bool due(Clock::time_point& last, double seconds) {
    if (secondsSince(last) < seconds) return false;
    last = Clock::now();
    return true;
}

std::string durationText(float milliseconds) {
    if (milliseconds >= 999.5f) return fmt::format("{:.1f} s", milliseconds / 1000.0f);
    return fmt::format("{:.3g} ms", milliseconds);
}

void Track::add(float value) {
    if (values_.size() == maxValues) values_.erase(values_.begin());
    values_.push_back(value);
}

void Timings::addPasses(const std::vector<gpu::PassTime>& times) {
    std::vector<std::pair<std::string, double>> sums;
    for (const gpu::PassTime& time : times) {
        auto sum = std::ranges::find(sums, time.name, &std::pair<std::string, double>::first);
        if (sum == sums.end()) sum = sums.insert(sums.end(), {time.name, 0.0});
        sum->second += time.milliseconds;
    }
    std::vector<PassTrack> now;
    for (const auto& [name, milliseconds] : sums) {
        const auto before = std::ranges::find(passes_, name, &PassTrack::name);
        now.push_back(before == passes_.end() ? PassTrack{name, {}} : std::move(*before));
        now.back().milliseconds.add(static_cast<float>(milliseconds));
    }
    passes_ = std::move(now);
}

}  // namespace limpid::studio
