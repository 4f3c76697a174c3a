#include "double_history.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid::test {
namespace {

/// Pixels. Several times the error of s in float32, an ulp: 2^-16 below 256 pixels.
constexpr double positionMargin = 1e-4;

/// Compares, and remembers whether float32 may have decided otherwise.
class Decision {
  public:
    bool above(double value, double threshold, double margin) {
        near(value, threshold, margin);
        return value > threshold;
    }
    void near(double value, double threshold, double margin) {
        doubtful_ = doubtful_ || std::abs(value - threshold) < margin;
    }
    bool doubtful() const { return doubtful_; }

  private:
    bool doubtful_ = false;
};

/// `operands`: the magnitude of what the value was computed from, for thresholds far smaller than that.
double marginOf(double threshold, double operands) {
    return 1e-4 * std::abs(threshold) + 1e-6 * operands;
}

struct Tap {
    dvec4 value;
    double weight;
};

double weightOf(const std::vector<Tap>& taps) {
    double sum = 0.0;
    for (const Tap& tap : taps) sum += tap.weight;
    return sum;
}

dvec4 meanOf(const std::vector<Tap>& taps) {
    dvec4 sum(0.0);
    for (const Tap& tap : taps) sum += tap.weight * tap.value;
    return sum / weightOf(taps);
}

/// Bound of the mean's change per pixel in x and y. A bilinear weight changes by at most 2 then, and as it
/// does, the mean changes by (value - mean) / (sum of weights).
dvec4 slopeOf(const std::vector<Tap>& taps) {
    const dvec4 mean = meanOf(taps);
    dvec4 sum(0.0);
    for (const Tap& tap : taps) sum += 2.0 * glm::abs(tap.value - mean);
    return sum / weightOf(taps);
}

/// What a surface point must have looked like in the previous frame.
struct Expected {
    dvec3 normal, modulation;
    double distance, id;
    double tolerance, toleranceMargin;  ///< t, and how close to it float32 may err
};

/// A pixel's history before its new sample.
struct Old {
    int failure;
    dvec4 colour{0.0}, slope{0.0};
};

class Tracker {
  public:
    Tracker(const denoise::HostFrame& frame, const HistoryImages& previous, const DoubleHistoryParams& params)
        : frame_(frame),
          camera_(frame.camera),
          size_(frame.width, frame.height),
          previous_(previous),
          params_(params) {}

    void track(size_t p, HistoryResult& result) const;

  private:
    Old find(size_t p, Decision& decision) const;
    Expected expect(size_t p, const dvec3& motion) const;
    bool inPicture(const dvec2& s, Decision& decision) const;
    bool agrees(const Expected& expected, size_t q, Decision& decision) const;
    void addTap(std::vector<Tap>& taps, const Expected& expected, const dvec2& q, double weight,
                Decision& decision) const;
    std::vector<Tap> bilinearTaps(const Expected& expected, const dvec2& s, Decision& decision) const;
    std::vector<Tap> searchedTaps(const Expected& expected, const dvec2& s, Decision& decision) const;
    double countAfter(double count) const;

    DoubleFrame frame_;
    const CameraParams& camera_;
    dvec2 size_;
    const HistoryImages& previous_;
    const DoubleHistoryParams& params_;
};

Expected Tracker::expect(size_t p, const dvec3& motion) const {
    Expected e{frame_.previousNormal(p),
               modulation(frame_.albedo(p)),
               frame_.distance(p) + motion.z,
               frame_.id(p),
               params_.depth,
               0.0};
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
    // Near c = 1 sqrt(1 - c^2) keeps half of float32's digits.
    e.toleranceMargin = marginOf(e.tolerance, std::abs(e.distance)) + 1e-3 * footprint;
    return e;
}

bool Tracker::inPicture(const dvec2& s, Decision& decision) const {
    bool inside = true;
    for (int axis = 0; axis < 2; ++axis) {
        inside = inside && !decision.above(0.0, s[axis], positionMargin) &&
                 decision.above(size_[axis], s[axis], positionMargin);
    }
    return inside;
}

/// A test is only asked where those before it passed: where they did not, it would decide nothing.
bool Tracker::agrees(const Expected& expected, size_t q, Decision& decision) const {
    const dvec4& was = previous_.normalDepth[q];
    const double cosine = glm::dot(expected.normal, dvec3(was));
    return was.w > 0.0 && previous_.colour[q].w > 0.0 && previous_.albedoId[q].w == expected.id &&
           decision.above(cosine, params_.normal, marginOf(params_.normal, 1.0)) &&
           decision.above(expected.tolerance, std::abs(expected.distance - was.w), expected.toleranceMargin);
}

void Tracker::addTap(std::vector<Tap>& taps, const Expected& expected, const dvec2& q, double weight,
                     Decision& decision) const {
    if (q.x < 0.0 || q.y < 0.0 || q.x >= size_.x || q.y >= size_.y) return;
    const size_t at = static_cast<size_t>(q.y) * previous_.width + static_cast<size_t>(q.x);
    if (!agrees(expected, at, decision)) return;
    dvec4 value = previous_.colour[at];
    if (params_.demodulate) {
        const dvec3 ratio = expected.modulation / modulation(dvec3(previous_.albedoId[at]));
        value = dvec4(dvec3(value) * ratio, value.w);
    }
    taps.push_back({value, weight});
}

/// Where rounding moves s across the centre of a pixel, other taps come in, but with a weight next to 0: the
/// mean is continuous there, and nothing is doubtful. Taps of weight 0, as where nothing moves, are not
/// asked.
std::vector<Tap> Tracker::bilinearTaps(const Expected& expected, const dvec2& s, Decision& decision) const {
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

std::vector<Tap> Tracker::searchedTaps(const Expected& expected, const dvec2& s, Decision& decision) const {
    // Weights are equal here: whole pixels come and go where rounding moves s across a pixel's edge.
    for (int axis = 0; axis < 2; ++axis) decision.near(s[axis], std::round(s[axis]), positionMargin);
    std::vector<Tap> taps;
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) addTap(taps, expected, glm::floor(s) + dvec2(i, j), 1.0, decision);
    }
    return taps;
}

Old Tracker::find(size_t p, Decision& decision) const {
    if (!frame_.hit(p)) return {1};
    const std::optional<dvec3> motion = frame_.motion(p);
    if (!motion) return {2};
    const dvec2 pixel(static_cast<double>(p % previous_.width), static_cast<double>(p / previous_.width));
    const dvec2 s = pixel + 0.5 + dvec2(*motion);
    if (!inPicture(s, decision)) return {2};
    const Expected expected = expect(p, *motion);
    const std::vector<Tap> taps = bilinearTaps(expected, s, decision);
    if (decision.above(weightOf(taps), 0.01, positionMargin)) return {0, meanOf(taps), slopeOf(taps)};
    if (!params_.search) return {3};
    const std::vector<Tap> searched = searchedTaps(expected, s, decision);
    if (searched.empty()) return {3};
    return {0, meanOf(searched)};
}

double Tracker::countAfter(double count) const {
    return params_.maxHistory == 0 ? count + 1.0 : std::min<double>(count + 1.0, params_.maxHistory);
}

/// C as the shader sees it, in float32: a sum that overflows there is infinite.
bool isFinite(const dvec3& c) {
    const dvec3 a = glm::abs(c);
    constexpr double largest = std::numeric_limits<float>::max();
    return a.x <= largest && a.y <= largest && a.z <= largest;
}

void Tracker::track(size_t p, HistoryResult& result) const {
    Decision decision;
    const Old old = find(p, decision);
    const dvec3 c = frame_.scattered(p);
    HistoryPixel& pixel = result.pixels[p];
    pixel = {old.failure, !isFinite(c), decision.doubtful(), old.slope};
    dvec4& colour = result.images.colour[p];
    if (pixel.rejected) {
        colour = old.colour;  // zeros where nothing was found
    } else {
        const bool grey = params_.greyRestart && old.failure >= 2;
        const dvec4 before = grey ? dvec4(0.5, 0.5, 0.5, 1.0) : old.colour;
        const double count = countAfter(before.w);
        const dvec3 step = c - dvec3(before);
        colour = dvec4(dvec3(before) + step / count, count);
        pixel.slope =
            dvec4(dvec3(old.slope) * (1.0 - 1.0 / count) + glm::abs(step) * old.slope.w / (count * count),
                  old.slope.w);
    }
    result.images.normalDepth[p] = dvec4(frame_.normal(p), frame_.distance(p));
    result.images.albedoId[p] = dvec4(frame_.albedo(p), frame_.id(p));
}

HistoryImages blankImages(uint32_t width, uint32_t height) {
    const std::vector<dvec4> zeros(size_t{width} * height, dvec4(0.0));
    return {width, height, zeros, zeros, zeros};
}

}  // namespace

HistoryResult trackHistory(const denoise::HostFrame& frame, const HistoryImages& previous,
                           const DoubleHistoryParams& params) {
    const HistoryImages blank = blankImages(frame.width, frame.height);
    const bool fits = previous.width == frame.width && previous.height == frame.height;
    const Tracker tracker(frame, fits ? previous : blank, params);
    HistoryResult result{blank, std::vector<HistoryPixel>(frame.pixelCount())};
    for (size_t p = 0; p < frame.pixelCount(); ++p) tracker.track(p, result);
    return result;
}

}  // namespace limpid::test
