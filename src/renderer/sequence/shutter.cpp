#include "renderer/sequence/shutter.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/hash.h"

namespace limpid {

double Shutter::offset(double instant) const {
    const double opens = position == Position::Start ? 0.0 : position == Position::Center ? -0.5 : -1.0;
    return open * (opens + instant);
}

Shutter::Position parseShutterPosition(std::string_view name) {
    const auto found = std::ranges::find(Shutter::positionNames, name);
    if (found == Shutter::positionNames.end())
        throw UsageError(fmt::format("'{}' is not start, center or end", name));
    return static_cast<Shutter::Position>(found - Shutter::positionNames.begin());
}

std::string_view nameOf(Shutter::Position position) {
    return Shutter::positionNames.at(static_cast<size_t>(position));
}

std::string toString(const Shutter& shutter) {
    if (!shutter.isOpen()) return "closed";
    return fmt::format("{} frames, {}", shutter.open, nameOf(shutter.position));
}

double shutterInstant(uint32_t seed, uint64_t frame, uint64_t launch) {
    constexpr uint64_t goldenRatio = 0x9e3779b97f4a7c15;  // its fraction times 2^64
    Hash64 hash;
    hash.addValue(frame);
    hash.addValue(uint64_t{seed});
    // Fixed point with 64 bits, whose overflow is the remainder that is wanted.
    const uint64_t instant = hash.value() + launch * goldenRatio;
    return static_cast<double>(instant >> 11) * 0x1p-53;
}

}  // namespace limpid
