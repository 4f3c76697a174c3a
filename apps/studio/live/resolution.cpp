#include "studio/live/resolution.h"

#include <algorithm>
#include <cmath>

namespace limpid::studio {
namespace {

constexpr int largestDivisor = 8;
constexpr double longSeconds = 0.15;  ///< of a frame that is worth giving up, with its mean or histories
/// A running movement keeps its divisor until a frame takes this many times longer or shorter than it may:
/// each other size starts the histories anew.
constexpr double tooSlow = 1.8, tooFast = 0.3;
/// Share of the newest time in the running mean.
constexpr double newest = 0.5;

uint64_t pixelsOf(gpu::Extent extent) {
    return uint64_t{extent.width} * extent.height;
}

}  // namespace

gpu::Extent divided(gpu::Extent viewport, int divisor) {
    const auto side = [&](uint32_t pixels) {
        return pixels == 0 ? 0u : std::max(pixels / static_cast<uint32_t>(divisor), 1u);
    };
    return {side(viewport.width), side(viewport.height)};
}

void ResolutionControl::note(uint64_t pixels, double seconds) {
    if (pixels == 0) return;
    const double now = seconds / static_cast<double>(pixels);
    secondsPerPixel_ = secondsPerPixel_ == 0.0 ? now : secondsPerPixel_ + newest * (now - secondsPerPixel_);
}

bool ResolutionControl::takesLong(uint64_t pixels) const {
    return secondsPerPixel_ == 0.0 || secondsPerPixel_ * static_cast<double>(pixels) > longSeconds;
}

int ResolutionControl::divisorFor(uint64_t pixels) const {
    if (secondsPerPixel_ == 0.0) return slowDevice_ ? firstDivisor : 1;
    const double seconds = secondsPerPixel_ * static_cast<double>(pixels);
    const double divisor = std::ceil(std::sqrt(seconds / movingSeconds) - 0.05);
    return static_cast<int>(std::clamp(divisor, 1.0, double{largestDivisor}));
}

gpu::Extent ResolutionControl::choose(gpu::Extent viewport, Resolution wanted, bool moves) {
    coarse_ = false;
    if (wanted != Resolution::Automatic) {
        moving_ = 0;
        return divided(viewport, 1 << (static_cast<int>(wanted) - 1));
    }
    const bool unknown = secondsPerPixel_ == 0.0;
    if (!moves && !unknown) {
        moving_ = 0;
        return viewport;
    }
    const int best = divisorFor(pixelsOf(viewport));
    if (moving_ == 0) {
        moving_ = best;
    } else if (best != moving_ && !unknown) {
        const double seconds = secondsPerPixel_ * static_cast<double>(pixelsOf(divided(viewport, moving_)));
        if (seconds > tooSlow * movingSeconds || seconds < tooFast * movingSeconds) moving_ = best;
    }
    coarse_ = moving_ > 1;
    return divided(viewport, moving_);
}

}  // namespace limpid::studio
