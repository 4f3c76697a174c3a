#include "tests/oracle/double_reprojection.h"

#include <algorithm>
#include <cmath>

namespace limpid::test {
namespace {

/// Margin for comparisons of the position s, in pixels: several times its error in float32, which is one ulp
/// (2^-16 for pictures up to 256 pixels).
constexpr double positionMargin = 1e-4;

/// Returns the margin for comparing a float32 value with a threshold. `operands`: magnitude of the values
/// that were subtracted; rounding is relative to it, even if the threshold is much smaller.
double marginOf(double threshold, double operands) {
    return 1e-4 * std::abs(threshold) + 1e-6 * operands;
}

/// As a device stores it, with 13 bits of mantissa.
double storedDistance(double z) {
    int exponent = 0;
    const double mantissa = std::frexp(z, &exponent);
    return std::ldexp(std::floor(std::ldexp(mantissa, 14) + 0.5), exponent - 14);
}

double weightOf(const std::vector<Tap>& taps) {
    double sum = 0.0;
    for (const Tap& tap : taps) sum += tap.weight;
    return sum;
}

}  // namespace

void Decision::near(double value, double threshold, double margin) {
    doubtful_ = doubtful_ || std::abs(value - threshold) < margin;
}

/// What the previous frame is expected to show of a surface point.
struct Reprojector::Expected {
    dvec3 normal;
    double distance, id;
    double tolerance, toleranceMargin;  ///< t, and the margin for float32's error
    double sharpness;
};

Reprojector::Reprojector(const denoise::HostFrame& frame, const std::vector<PreviousSurface>& previous,
                         const ReprojectionParams& params)
    : frame_(frame),
      camera_(frame.camera),
      size_(frame.width, frame.height),
      previous_(previous),
      params_(params) {}

Reprojector::Expected Reprojector::expect(size_t p, const dvec3& motion) const {
    Expected e{frame_.previousNormal(p),
               storedDistance(frame_.distance(p)) + motion.z,
               frame_.id(p),
               params_.depth,
               0.0,
               params_.sharpness.empty() ? 0.0 : params_.sharpness[p]};
    double footprint = 0.0;
    if (params_.relative) {
        const bool orthographic = camera_.orthographic != 0;
        const dvec3 along = orthographic ? dvec3(camera_.forward) : glm::normalize(frame_.ray(p));
        const double c = std::max(std::abs(glm::dot(frame_.normal(p), along)), 0.05);
        const double tangent = std::sqrt(std::max(1.0 - c * c, 0.0)) / c;
        const double width = orthographic ? double{camera_.spread} : e.distance * double{camera_.spread};
        footprint = 1.5 * width;
        e.tolerance = e.distance * params_.depth + footprint * tangent;
    }
    // Near c = 1, sqrt(1 - c^2) has only half of float32's digits.
    e.toleranceMargin = marginOf(e.tolerance, std::abs(e.distance)) + 1e-3 * footprint;
    return e;
}

bool Reprojector::inPicture(const dvec2& s, Decision& decision) const {
    bool inside = true;
    for (int axis = 0; axis < 2; ++axis) {
        inside = inside && !decision.above(0.0, s[axis], positionMargin) &&
                 decision.above(size_[axis], s[axis], positionMargin);
    }
    return inside;
}

/// Each test is only evaluated if those before it passed; otherwise its result does not matter.
bool Reprojector::agrees(const Expected& expected, const PreviousSurface& was, Decision& decision) const {
    return was.distance > 0.0 && was.hasHistory && (!params_.identity || was.id == expected.id) &&
           decision.above(glm::dot(expected.normal, was.normal), params_.normal,
                          marginOf(params_.normal, 1.0)) &&
           decision.above(expected.tolerance, std::abs(expected.distance - was.distance),
                          expected.toleranceMargin);
}

void Reprojector::addTap(std::vector<Tap>& taps, const Expected& expected, const dvec2& q, double weight,
                         Decision& decision) const {
    if (q.x < 0.0 || q.y < 0.0 || q.x >= size_.x || q.y >= size_.y) return;
    const size_t at = static_cast<size_t>(q.y) * static_cast<size_t>(size_.x) + static_cast<size_t>(q.x);
    if (!agrees(expected, previous_[at], decision)) return;
    const double lobe =
        std::exp(-expected.sharpness * (1.0 - glm::dot(expected.normal, previous_[at].normal)));
    taps.push_back({at, weight * lobe});
}

/// If rounding moves s across the centre of a pixel, other taps are used, but with a weight close to 0: the
/// mean is continuous there, so nothing is doubtful. Taps of weight 0, as without motion, are not tested.
std::vector<Tap> Reprojector::bilinearTaps(const Expected& expected, const dvec2& s,
                                           Decision& decision) const {
    const dvec2 f = s - 0.5, first = glm::floor(f), fraction = f - first;
    std::vector<Tap> taps;
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const double weight =
                (i == 0 ? 1.0 - fraction.x : fraction.x) * (j == 0 ? 1.0 - fraction.y : fraction.y);
            if (weight > 0.0) addTap(taps, expected, first + dvec2(i, j), weight, decision);
        }
    }
    return taps;
}

std::vector<Tap> Reprojector::searchedTaps(const Expected& expected, const dvec2& s,
                                           Decision& decision) const {
    // Weights are equal here, so if rounding moves s across a pixel's edge, whole pixels enter or leave the
    // mean.
    for (int axis = 0; axis < 2; ++axis) decision.near(s[axis], std::round(s[axis]), positionMargin);
    std::vector<Tap> taps;
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) addTap(taps, expected, glm::floor(s) + dvec2(i, j), 1.0, decision);
    }
    return taps;
}

Reprojection Reprojector::find(size_t p, const std::optional<dvec3>& motion, Decision& decision) const {
    if (!frame_.hit(p)) return {1, {}};
    if (!motion) return {2, {}};
    const auto columns = static_cast<size_t>(size_.x);
    const dvec2 pixel(static_cast<double>(p % columns), static_cast<double>(p / columns));
    const dvec2 s = pixel + 0.5 + dvec2(*motion);
    if (!inPicture(s, decision)) return {2, {}};
    const Expected expected = expect(p, *motion);
    const std::vector<Tap> taps = bilinearTaps(expected, s, decision);
    if (decision.above(weightOf(taps), 0.01, positionMargin)) return {0, taps};
    if (!params_.search) return {3, {}};
    const std::vector<Tap> searched = searchedTaps(expected, s, decision);
    return {searched.empty() ? 3 : 0, searched, true};
}

}  // namespace limpid::test
