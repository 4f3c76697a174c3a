// Chooses how many pixels are rendered so that the picture follows the hand also on slow devices.
#pragma once

#include <cstdint>

#include "gpu/graph/frame_graph.h"
#include "studio/state/state.h"

namespace limpid::studio {

/// The viewport with its sides divided; at least one pixel each, unless it has none.
gpu::Extent divided(gpu::Extent viewport, int divisor);

/// Divisors of the viewport's sides. A frame's time grows with its pixels, so the measured time of one frame
/// tells that of others; the choice never depends on the number of pixels alone.
class ResolutionControl {
  public:
    /// Longest time of a frame while something moves, seconds.
    static constexpr double movingSeconds = 1.0 / 15.0;
    /// Longest time that the first picture may take on a device of which nothing is known.
    static constexpr int firstDivisor = 8;

    /// `slowDevice`: a CPU. Nothing is known of the time of a frame: the first one is coarse there.
    explicit ResolutionControl(bool slowDevice) : slowDevice_(slowDevice) {}

    /// Other work from now on: another pipeline, other samples, another scene. Forgets the times.
    void forget() { secondsPerPixel_ = 0.0; }
    /// A frame of so many pixels has taken so long.
    void note(uint64_t pixels, double seconds);
    /// The extent of the next frame. `moves`: something has changed less than a moment ago.
    gpu::Extent choose(gpu::Extent viewport, Resolution wanted, bool moves);
    /// Whether a frame of so many pixels takes so long that a hand would wait for it; also if nothing is
    /// known.
    bool takesLong(uint64_t pixels) const;
    /// The last choice was smaller than the viewport although nothing limits it at rest.
    bool isCoarse() const { return coarse_; }

  private:
    int divisorFor(uint64_t pixels) const;

    bool slowDevice_;
    double secondsPerPixel_ = 0.0;  ///< 0: unknown
    int moving_ = 0;                ///< divisor of the movement that goes on; 0: none does
    bool coarse_ = false;
};

}  // namespace limpid::studio
