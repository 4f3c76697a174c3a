#include "tests/oracle/double_edges.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/oracle/double_taa.h"

namespace limpid::test {
namespace {

struct Pixel {
    int64_t x, y;
};

class EdgeSmoother {
  public:
    EdgeSmoother(const denoise::HostFrame& frame, int64_t reach)
        : frame_(frame),
          width_(frame.width),
          height_(frame.height),
          reach_(reach),
          borders_(frame.pixelCount()) {
        for (int64_t line = 0; line < height_; ++line) goAlong(line, width_, false);
        for (int64_t line = 0; line < width_; ++line) goAlong(line, height_, true);
    }

    /// What the neighbours cover of a pixel.
    struct Border {
        size_t neighbour;
        double share;
    };
    const std::vector<Border>& bordersOf(size_t p) const { return borders_[p]; }

  private:
    size_t indexOf(const Pixel& p) const { return static_cast<size_t>(p.y * width_ + p.x); }
    std::optional<size_t> at(const Pixel& p) const {
        if (p.x < 0 || p.y < 0 || p.x >= width_ || p.y >= height_) return std::nullopt;
        return indexOf(p);
    }
    double distance(size_t p) const {
        const double z = frame_.distance(p);
        return std::isfinite(z) ? std::max(z, 0.0) : 0.0;
    }
    bool isEdge(const Pixel& a, const Pixel& b) const {
        const std::optional<size_t> p = at(a), q = at(b);
        if (!p || !q) return false;
        const double z = distance(*p), other = distance(*q);
        if ((z > 0.0) != (other > 0.0)) return true;
        if (z == 0.0) return false;
        const dvec3 n = frame_.normal(*p), m = frame_.normal(*q);
        const bool known = isFiniteInFloat(n) && isFiniteInFloat(m) && n != dvec3(0.0) && m != dvec3(0.0);
        return std::abs(z - other) > 0.1 * std::min(z, other) || (known && glm::dot(n, m) < 0.85);
    }

    /// `i` along the line, `line` the row; or, if `down`, the other way round.
    static Pixel pixel(int64_t i, int64_t line, bool down) { return down ? Pixel{line, i} : Pixel{i, line}; }

    /// All edges between this line of pixels and the next one.
    void goAlong(int64_t line, int64_t length, bool down) {
        const auto edge = [&](int64_t i) { return isEdge(pixel(i, line, down), pixel(i, line + 1, down)); };
        for (int64_t i = 0; i < length; ++i) {
            if (!edge(i)) continue;
            const int64_t begin = i;
            while (i + 1 < length && edge(i + 1)) ++i;
            for (int64_t j = begin; j <= i; ++j) {
                cover(begin, i, j, line, line + 1, down);
                cover(begin, i, j, line + 1, line, down);
            }
        }
    }
    /// How the edge from `begin` to `end` covers pixel `i` of line `own` by that of line `other`.
    void cover(int64_t begin, int64_t end, int64_t i, int64_t own, int64_t other, bool down) {
        const auto turn = [&](int64_t before) {  // where a surface ends between `before` and the next
            const bool here = isEdge(pixel(before, own, down), pixel(before + 1, own, down));
            const bool there = isEdge(pixel(before, other, down), pixel(before + 1, other, down));
            return here == there ? 0.0 : here ? 0.5 : -0.5;
        };
        const int64_t left = std::min(i - begin, reach_), right = std::min(end - i, reach_);
        const double first = left < reach_ ? turn(begin - 1) : 0.0;
        const double last = right < reach_ ? turn(end) : 0.0;
        const double length = static_cast<double>(left + right + 1), t = static_cast<double>(left) + 0.5;
        double height = 0.0;
        if (first * last < 0.0)
            height = first + (last - first) * t / length;
        else
            height = t < length / 2.0 ? first * (1.0 - 2.0 * t / length) : last * (2.0 * t / length - 1.0);
        if (height > 0.0)
            borders_[indexOf(pixel(i, own, down))].push_back({indexOf(pixel(i, other, down)), height});
    }

    DoubleFrame frame_;
    int64_t width_, height_, reach_;
    std::vector<std::vector<Border>> borders_;
};

}  // namespace

std::vector<dvec3> smoothedEdges(const denoise::HostFrame& frame, const std::vector<float>& beauty,
                                 int64_t reach) {
    const EdgeSmoother smoother(frame, reach);
    const auto colorOf = [&](size_t p) { return dvec3(beauty[4 * p], beauty[4 * p + 1], beauty[4 * p + 2]); };
    std::vector<dvec3> result;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        double covered = 0.0;
        for (const auto& border : smoother.bordersOf(p)) covered += border.share;
        dvec3 mean = (1.0 - covered / std::max(covered, 1.0)) * taaEncode(colorOf(p));
        for (const auto& border : smoother.bordersOf(p))
            mean += border.share / std::max(covered, 1.0) * taaEncode(colorOf(border.neighbour));
        result.push_back(covered > 0.0 ? taaDecode(mean) : colorOf(p));
    }
    return result;
}

}  // namespace limpid::test
