// Reprojection into the previous frame in double precision: steps 1 to 4 of history tracking in
// docs/denoising.md. Shared by the oracles of the denoisers with a history.
#pragma once

#include <optional>
#include <vector>

#include "tests/oracle/double_frame.h"

namespace limpid::test {

/// Compares values, and records whether float32 might have decided otherwise.
class Decision {
  public:
    bool above(double value, double threshold, double margin) {
        near(value, threshold, margin);
        return value > threshold;
    }
    void near(double value, double threshold, double margin);
    bool doubtful() const { return doubtful_; }

  private:
    bool doubtful_ = false;
};

struct ReprojectionParams {
    double normal, depth;
    bool relative, search;
    bool identity = true;  ///< off: taps on other objects count too
    /// Taps weigh less by exp(-sharpness (1 - cosine of the normals)); by pixel of this frame. Empty: they do
    /// not.
    std::vector<double> sharpness{};
};

/// The surface seen by a pixel of the previous frame.
struct PreviousSurface {
    dvec3 normal{0.0};
    double distance = 0.0;  ///< 0: the ray misses
    double id = 0.0;
    bool hasHistory = false;  ///< its mean has at least one sample
};

struct Tap {
    size_t pixel;
    double weight;
};

struct Reprojection {
    int failure = 0;  ///< 0: there are taps; else the case of step 2, Disocclusion, in docs/denoising.md
    std::vector<Tap> taps;  ///< the taps that passed all tests
    bool searched = false;
};

class Reprojector {
  public:
    /// `previous` has as many pixels as the frame. All arguments must outlive this object.
    Reprojector(const denoise::HostFrame& frame, const std::vector<PreviousSurface>& previous,
                const ReprojectionParams& params);
    Reprojection find(size_t p, Decision& decision) const { return find(p, frame_.motion(p), decision); }
    /// Uses the given motion instead of the frame's, or none.
    Reprojection find(size_t p, const std::optional<dvec3>& motion, Decision& decision) const;

  private:
    struct Expected;
    Expected expect(size_t p, const dvec3& motion) const;
    bool inPicture(const dvec2& s, Decision& decision) const;
    bool agrees(const Expected& expected, const PreviousSurface& was, Decision& decision) const;
    void addTap(std::vector<Tap>& taps, const Expected& expected, const dvec2& q, double weight,
                Decision& decision) const;
    std::vector<Tap> bilinearTaps(const Expected& expected, const dvec2& s, Decision& decision) const;
    std::vector<Tap> searchedTaps(const Expected& expected, const dvec2& s, Decision& decision) const;

    DoubleFrame frame_;
    const CameraParams& camera_;
    dvec2 size_;
    const std::vector<PreviousSurface>& previous_;
    const ReprojectionParams& params_;
};

/// A mean over taps. `slope` bounds the change of the mean if the position moves by one pixel. Multiplied by
/// float32's error of the position, it bounds the error that a correct shader may have between noisy taps.
struct Resampled {
    dvec4 mean{0.0}, slope{0.0};
};

/// `valueAt` returns a tap's value for its pixel. Without taps, returns zeros.
template <typename ValueAt>
Resampled resample(const Reprojection& found, const ValueAt& valueAt) {
    Resampled result;
    double weights = 0.0;
    for (const Tap& tap : found.taps) {
        result.mean += tap.weight * dvec4(valueAt(tap.pixel));
        weights += tap.weight;
    }
    if (found.taps.empty()) return result;
    result.mean /= weights;
    if (found.searched) return result;  // equal weights, independent of the subpixel position of s
    // A bilinear weight changes by at most 2 per pixel, which changes the mean by (value - mean) / weights.
    for (const Tap& tap : found.taps)
        result.slope += 2.0 * glm::abs(dvec4(valueAt(tap.pixel)) - result.mean) / weights;
    return result;
}

}  // namespace limpid::test
