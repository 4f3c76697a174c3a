#include "tests/oracle/double_taa.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/oracle/double_reprojection.h"
#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {
namespace {

constexpr double deviations = 1.25, minDistance = 1e-6;
/// Step 5: the bend of distances at edges, those of x at soft and at hard edges of light, the share of the
/// frames away from edges, and the motion in pixels below which more frames count.
constexpr double edge = 0.005, soft = 0.1, hard = 0.3, innerShare = 0.15, moving = 0.1;
/// In pixels. Several times the error of s in float32, which is an ulp: 2^-16 below 256 pixels.
constexpr double positionMargin = 1e-4;
/// For encoded values, which are below 1 in magnitude: several operations' rounding.
constexpr double encodedRounding = 1e-6, clipRounding = 3e-7;

/// Statistics of the encoded beauty over the 3x3 pixels around one.
struct Around {
    dvec3 mean{0.0}, deviation{0.0};
    double brightest = 0.0;  ///< l
};

std::array<double, 4> catmullRom(double t) {
    return {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (-5.0 + 3.0 * t),
            0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
}

std::array<double, 3> parabola(double t) {
    return {0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)};
}

/// l of the colour of which `encoded` are the axes.
double luminanceOf(const dvec3& encoded) {
    const auto [x, y, z] = std::array{encoded.x, encoded.y, encoded.z};
    return luminance(dvec3(x + y - z, x + z, x - y - z));
}

/// Scaled down to the luminance `most`.
dvec3 limited(const dvec3& encoded, double most) {
    const double l = luminanceOf(encoded);
    return l > most ? encoded * (most / l) : encoded;
}

/// Step 4. `error` is added to the allowed difference of the components.
dvec3 clip(const dvec3& h, const Around& around, double error) {
    const dvec3 most = glm::max(deviations * around.deviation, dvec3(minDistance)) + error;
    const dvec3 e = glm::abs(h - around.mean) / most;
    return limited(around.mean + (h - around.mean) / std::max({e.x, e.y, e.z, 1.0}), around.brightest);
}

/// What step 5 takes from the 3x3 pixels.
struct Edges {
    bool isEdge = false;
    double hardness = 0.0;  ///< w
};

class Antialiaser {
  public:
    Antialiaser(const denoise::HostFrame& frame, const std::vector<float>& beauty, const TaaPast& past,
                const TaaFrames& frames, const dvec2& jitter);
    Antialiaser(const Antialiaser&) = delete;
    Antialiaser& operator=(const Antialiaser&) = delete;

    TaaPixel at(size_t p) const;

  private:
    size_t clamped(int64_t x, int64_t y) const {
        return static_cast<size_t>(std::clamp<int64_t>(y, 0, height_ - 1) * width_ +
                                   std::clamp<int64_t>(x, 0, width_ - 1));
    }
    std::array<size_t, 9> block(size_t p) const;
    Around around(size_t p) const;
    dvec3 atCentre(size_t p) const;
    Edges edgesAt(size_t p, Decision& decision) const;
    double stillness(const dvec2& motion, const Edges& edges) const;
    double averaged(const Edges& edges, double count, double still) const;
    std::optional<dvec3> motion(size_t p) const;
    size_t nearest(size_t p, Decision& decision) const;
    bool movesAlike(size_t p, size_t q) const;
    bool inPicture(const dvec2& s, Decision& decision) const;
    double countAfter(double count, double still) const {
        return std::min(count + 1.0, frames_.moving + still * (frames_.still - frames_.moving));
    }
    double countAt(const dvec2& s) const;
    double countAt(const dvec2& s, double still, Decision& decision) const;
    dvec3 pastAt(const dvec2& s) const;
    void addErrors(TaaPixel& pixel, const Edges& edges, double count, const dvec2& motion, const dvec2& s,
                   const Around& around, const dvec3& own) const;

    DoubleFrame frame_;
    int64_t width_, height_;
    TaaFrames frames_;
    dvec2 jitter_;
    std::vector<dvec3> encoded_;  ///< E(B)
    std::vector<dvec3> past_;     ///< E of the last frame's means; empty: no history
    std::vector<double> counts_;  ///< N of each pixel
};

Antialiaser::Antialiaser(const denoise::HostFrame& frame, const std::vector<float>& beauty,
                         const TaaPast& past, const TaaFrames& frames, const dvec2& jitter)
    : frame_(frame), width_(frame.width), height_(frame.height), frames_(frames), jitter_(jitter) {
    for (size_t p = 0; p < frame.pixelCount(); ++p)
        encoded_.push_back(taaEncode({beauty[4 * p], beauty[4 * p + 1], beauty[4 * p + 2]}));
    if (past.width != frame.width || past.height != frame.height) return;
    for (const dvec4& mean : past.mean) {
        past_.push_back(taaEncode(dvec3(mean)));
        counts_.push_back(mean.w);
    }
}

/// Returns the pixels in reading order.
std::array<size_t, 9> Antialiaser::block(size_t p) const {
    const auto x = static_cast<int64_t>(p) % width_, y = static_cast<int64_t>(p) / width_;
    std::array<size_t, 9> pixels{};
    for (size_t i = 0; i < 9; ++i)
        pixels[i] = clamped(x + static_cast<int64_t>(i % 3) - 1, y + static_cast<int64_t>(i / 3) - 1);
    return pixels;
}

Around Antialiaser::around(size_t p) const {
    Around result;
    for (const size_t q : block(p)) {
        result.mean += encoded_[q] / 9.0;
        result.brightest = std::max(result.brightest, luminanceOf(encoded_[q]));
    }
    dvec3 variance(0.0);
    for (const size_t q : block(p)) {
        const dvec3 difference = encoded_[q] - result.mean;
        variance += difference * difference / 9.0;
    }
    result.deviation = glm::sqrt(variance);
    return result;
}

/// Step 2.
dvec3 Antialiaser::atCentre(size_t p) const {
    const std::array<double, 3> across = parabola(-jitter_.x), down = parabola(-jitter_.y);
    const std::array<size_t, 9> pixels = block(p);
    dvec3 sum(0.0), least = encoded_[p], most = encoded_[p];
    double brightest = 0.0;
    for (size_t i = 0; i < 9; ++i) {
        const dvec3& e = encoded_[pixels[i]];
        sum += across[i % 3] * down[i / 3] * e;
        least = glm::min(least, e);
        most = glm::max(most, e);
        brightest = std::max(brightest, luminanceOf(e));
    }
    return limited(glm::clamp(sum, least, most), brightest);
}

/// Step 5: the largest bend of four triples through the middle of `values`, in reading order.
double bendOf(const std::array<double, 9>& values) {
    double most = 0.0;
    for (size_t i = 0; i < 4; ++i) {
        const double largest = std::max({values[i], values[8 - i], values[4]});
        if (largest > 0.0)
            most = std::max(most, std::abs(values[i] + values[8 - i] - 2.0 * values[4]) / largest);
    }
    return most;
}

Edges Antialiaser::edgesAt(size_t p, Decision& decision) const {
    const std::array<size_t, 9> pixels = block(p);
    std::array<double, 9> distances{}, lumas{};
    for (size_t i = 0; i < 9; ++i) {
        const double z = frame_.distance(pixels[i]);
        distances[i] = std::isfinite(z) ? std::max(z, 0.0) : 0.0;
        lumas[i] = encoded_[pixels[i]].x;
    }
    if (jitter_ == dvec2(0.0) || past_.empty()) return {true, 0.0};
    return {decision.above(bendOf(distances), edge, 1e-6),
            std::clamp((bendOf(lumas) - soft) / (hard - soft), 0.0, 1.0)};
}

/// Step 5: r.
double Antialiaser::stillness(const dvec2& motion, const Edges& edges) const {
    return edges.hardness * std::max(1.0 - glm::length(motion) / moving, 0.0);
}

/// Step 5: N''.
double Antialiaser::averaged(const Edges& edges, double count, double still) const {
    const double share = edges.isEdge ? 1.0 : innerShare + (1.0 - innerShare) * still;
    return 1.0 + share * (countAfter(count, still) - 1.0);
}

/// Motion with NaN or infinity counts as missing.
std::optional<dvec3> Antialiaser::motion(size_t p) const {
    const std::optional<dvec3> m = frame_.motion(p);
    return m && isFiniteInFloat(*m) ? m : std::nullopt;
}

bool Antialiaser::movesAlike(size_t p, size_t q) const {
    const std::optional<dvec3> a = motion(p), b = motion(q);
    if (!a || !b) return !a && !b;
    return glm::distance(dvec2(*a), dvec2(*b)) < 0.1 * positionMargin;  // covered by the slope
}

/// Distances that are equal in double are equal in float32; nearly equal ones may become equal.
size_t Antialiaser::nearest(size_t p, Decision& decision) const {
    const std::array<size_t, 9> pixels = block(p);
    size_t nearest = p;
    double least = 0.0;
    for (const size_t q : pixels) {
        const double z = frame_.distance(q);
        if (!(z > 0.0) || !std::isfinite(z) || (least > 0.0 && z >= least)) continue;
        nearest = q;
        least = z;
    }
    for (const size_t q : pixels) {
        const double z = frame_.distance(q);
        if (z > least && !movesAlike(q, nearest)) decision.near(z, least, 3e-7 * least);
    }
    return nearest;
}

bool Antialiaser::inPicture(const dvec2& s, Decision& decision) const {
    const dvec2 size(width_, height_);
    bool inside = true;
    for (int axis = 0; axis < 2; ++axis) {
        inside = inside && !decision.above(0.0, s[axis], positionMargin) &&
                 decision.above(size[axis], s[axis], positionMargin);
    }
    return inside;
}

double Antialiaser::countAt(const dvec2& s) const {
    const dvec2 pixel = glm::floor(s);
    return counts_[clamped(static_cast<int64_t>(pixel.x), static_cast<int64_t>(pixel.y))];
}

double Antialiaser::countAt(const dvec2& s, double still, Decision& decision) const {
    const double count = countAt(s);
    for (const double x : {-positionMargin, positionMargin}) {
        for (const double y : {-positionMargin, positionMargin}) {
            if (countAfter(countAt(s + dvec2(x, y)), still) == countAfter(count, still)) continue;
            for (int axis = 0; axis < 2; ++axis) decision.near(s[axis], std::round(s[axis]), positionMargin);
        }
    }
    return count;
}

/// If rounding moves s across the centre of a pixel, other taps are used, but the mean is continuous there,
/// and its derivative nearly, so nothing is doubtful.
dvec3 Antialiaser::pastAt(const dvec2& s) const {
    const dvec2 first = glm::floor(s - 0.5), fraction = s - 0.5 - first;
    const std::array<double, 4> across = catmullRom(fraction.x), down = catmullRom(fraction.y);
    const auto x = static_cast<int64_t>(first.x) - 1, y = static_cast<int64_t>(first.y) - 1;
    const auto value = [&](int64_t i, int64_t j) { return past_[clamped(x + i, y + j)]; };
    dvec3 sum(0.0);
    for (int64_t j = 0; j < 4; ++j) {
        for (int64_t i = 0; i < 4; ++i) {
            const int64_t u = std::clamp<int64_t>(i, 1, 2), v = std::clamp<int64_t>(j, 1, 2);
            const bool corner = u != i && v != j;
            sum += across[static_cast<size_t>(i)] * down[static_cast<size_t>(j)] *
                   (corner ? value(u, j) + value(i, v) - value(u, v) : value(i, j));
        }
    }
    return sum;
}

/// Determined by trial, since the clip and E^-1 change what the cubic's derivative alone would give.
void Antialiaser::addErrors(TaaPixel& pixel, const Edges& edges, double count, const dvec2& motion,
                            const dvec2& s, const Around& around, const dvec3& own) const {
    const auto meanWith = [&](const dvec2& off, double error) {
        const dvec3 h = clip(pastAt(s + off), around, error);
        return taaDecode(h + (own - h) / averaged(edges, count, stillness(motion + off, edges)));
    };
    dvec3 clipped(0.0);
    for (const double sign : {-1.0, 1.0}) {
        clipped = glm::max(clipped, glm::abs(meanWith(dvec2(0.0), sign * clipRounding) - pixel.mean));
    }
    pixel.rounding += clipped;
    for (int axis = 0; axis < 2; ++axis) {
        dvec3 most(0.0);
        for (const double sign : {-1.0, 1.0}) {
            dvec2 off(0.0);
            off[axis] = sign * positionMargin;
            most = glm::max(most, glm::abs(meanWith(off, 0.0) - pixel.mean) / positionMargin);
        }
        pixel.slope += most;
    }
}

TaaPixel Antialiaser::at(size_t p) const {
    Decision decision;
    const dvec3 own = atCentre(p);
    const std::optional<dvec3> m = past_.empty() ? std::nullopt : motion(nearest(p, decision));
    const dvec2 centre(static_cast<double>(static_cast<int64_t>(p) % width_) + 0.5,
                       static_cast<double>(static_cast<int64_t>(p) / width_) + 0.5);
    const dvec2 moved = m ? dvec2(*m) : dvec2(0.0), s = centre + moved;
    const Edges edges = edgesAt(p, decision);
    const double still = m ? stillness(moved, edges) : 0.0;
    const double count = m && inPicture(s, decision) ? countAt(s, still, decision) : 0.0;
    TaaPixel pixel;
    pixel.frames = countAfter(count, still);
    const Around surroundings = around(p);
    const dvec3 h = count > 0.0 ? clip(pastAt(s), surroundings, 0.0) : own;
    pixel.mean = taaDecode(h + (own - h) / averaged(edges, count, still));
    // c = e / (1 - l) has the derivatives 1 / (1 - l) = 1 + l by e and c (1 + l) by l.
    pixel.rounding = encodedRounding * (1.0 + luminance(pixel.mean)) * (1.0 + pixel.mean);
    if (count > 0.0) addErrors(pixel, edges, count, moved, s, surroundings, own);
    pixel.doubtful = decision.doubtful();
    return pixel;
}

}  // namespace

dvec3 taaEncode(const dvec3& color) {
    const dvec3 c = color / (1.0 + luminance(color));
    return {0.25 * (c.r + 2.0 * c.g + c.b), 0.5 * (c.r - c.b), 0.25 * (-c.r + 2.0 * c.g - c.b)};
}

dvec3 taaDecode(const dvec3& encoded) {
    const auto [x, y, z] = std::array{encoded.x, encoded.y, encoded.z};
    const dvec3 c = glm::max(dvec3(x + y - z, x + z, x - y - z), dvec3(0.0));
    return c / std::max(1.0 - luminance(c), 1e-6);
}

std::vector<TaaPixel> taa(const denoise::HostFrame& frame, const std::vector<float>& beauty,
                          const TaaPast& past, const TaaFrames& frames, const dvec2& jitter) {
    const Antialiaser antialiaser(frame, beauty, past, frames, jitter);
    std::vector<TaaPixel> pixels;
    for (size_t p = 0; p < frame.pixelCount(); ++p) pixels.push_back(antialiaser.at(p));
    return pixels;
}

}  // namespace limpid::test
