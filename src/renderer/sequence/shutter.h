// Motion blur: when the shutter is open around the time of a frame, and the instants at which samples are
// taken.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace limpid {

/// All pixels of one launch see the same instant; successive launches see others.
struct Shutter {
    /// Where the open shutter lies: it opens at the frame's time, is centred on it, or closes at it.
    enum class Position { Start, Center, End };
    static constexpr std::array<std::string_view, 3> positionNames{"start", "center", "end"};

    double open = 0.0;  ///< frames, 0 to 100; 0.5 is a film camera's 180 degrees; 0: no motion blur
    Position position = Position::Center;

    bool isOpen() const { return open > 0.0; }
    /// Returns the time from the frame's, in frames, at `instant`: 0 (opens) to 1 (closes).
    double offset(double instant) const;
    bool operator==(const Shutter&) const = default;
};

std::string_view nameOf(Shutter::Position position);
/// One of Shutter::positionNames. Throws UsageError for anything else.
Shutter::Position parseShutterPosition(std::string_view name);
/// For records and messages: "closed", or like "0.5 frames, center".
std::string toString(const Shutter& shutter);

/// Returns the instant, in [0,1), of a launch of a frame. The launches of a frame are the Kronecker sequence
/// of the golden ratio, which covers [0,1) evenly however many there are, plus a random number, which makes
/// the mean of each launch right and differs from frame to frame. (Base 2 would be evenly spread, too, but
/// Sobol' points have it in the pixel already.)
double shutterInstant(uint32_t seed, uint64_t frame, uint64_t launch);

}  // namespace limpid
