#include "shot/motion/block_matching.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace limpid::shot {
namespace {

constexpr int blockSide = 8;
constexpr int stepsPerPixel = 8;  ///< motion is counted in eighths of a pixel
/// At the coarsest level all motion up to this is tried, in pixels.
constexpr int coarsestReach = 4;
/// What a pixel of difference from the motion around costs: as much as so many steps in the sum over a block.
constexpr int penaltyPerPixel = 96;
constexpr int penaltyReach = 3 * stepsPerPixel;
/// In noise the first pixel costs more: this part of the difference.
constexpr int noiseShare = 8;
/// A block whose difference from itself, one pixel further, is this counts as half of a clear texture.
constexpr float halfTexture = 512.0f;
/// Motion of the surroundings replaces a block's own if it costs at most so much more.
constexpr int fillSlack = 48;

struct Offset {
    int x = 0, y = 0;
    bool operator==(const Offset&) const = default;
};
Offset operator+(const Offset& a, const Offset& b) {
    return {a.x + b.x, a.y + b.y};
}

/// 9x9 pixels, of which some may be outside the picture.
struct Patch {
    std::array<GuideTexel, size_t{blockSide + 1} * (blockSide + 1)> texels;
    const GuideTexel* rows = nullptr;
    size_t stride = 0;

    Patch(const GuideLevel& level, int x, int y) {
        const int side = blockSide + 1;
        if (x >= 0 && y >= 0 && x + side <= level.width && y + side <= level.height) {
            rows = &level.at(x, y);
            stride = static_cast<size_t>(level.width);
            return;
        }
        for (int v = 0; v < side; ++v)
            for (int u = 0; u < side; ++u)
                texels[static_cast<size_t>(v * side + u)] = level.clamped(x + u, y + v);
        rows = texels.data();
        stride = static_cast<size_t>(side);
    }
    Patch(const Patch&) = delete;
    Patch& operator=(const Patch&) = delete;
};

constexpr size_t rowBytes = size_t{blockSide} * sizeof(GuideTexel);

const uint8_t* bytesOf(const GuideTexel* texels) {
    return texels->data();
}

int differenceOfRows(const uint8_t* a, const uint8_t* b) {
    int sum = 0;
    for (size_t i = 0; i < rowBytes; ++i) sum += std::abs(int{a[i]} - int{b[i]});
    return sum;
}

/// Between four pixels, with weights that add up to stepsPerPixel * stepsPerPixel.
void interpolateRow(const uint8_t* upper, const uint8_t* lower, int fx, int fy, uint8_t* to) {
    const auto a = static_cast<uint16_t>((stepsPerPixel - fx) * (stepsPerPixel - fy)),
               b = static_cast<uint16_t>(fx * (stepsPerPixel - fy)),
               c = static_cast<uint16_t>((stepsPerPixel - fx) * fy), d = static_cast<uint16_t>(fx * fy);
    constexpr size_t next = sizeof(GuideTexel);
    for (size_t i = 0; i < rowBytes; ++i) {
        const int sum = a * upper[i] + b * upper[i + next] + c * lower[i] + d * lower[i + next];
        to[i] =
            static_cast<uint8_t>((sum + stepsPerPixel * stepsPerPixel / 2) / (stepsPerPixel * stepsPerPixel));
    }
}

/// The sum of the differences of all components of the block at (x, y), moved by m.
int blockDifference(const GuideLevel& now, const GuideLevel& before, int x, int y, const Offset& m) {
    const int wholeX = m.x >= 0 ? m.x / stepsPerPixel : -((stepsPerPixel - 1 - m.x) / stepsPerPixel);
    const int wholeY = m.y >= 0 ? m.y / stepsPerPixel : -((stepsPerPixel - 1 - m.y) / stepsPerPixel);
    const int fx = m.x - wholeX * stepsPerPixel, fy = m.y - wholeY * stepsPerPixel;
    const Patch a(now, x, y), b(before, x + wholeX, y + wholeY);
    int sum = 0;
    for (size_t row = 0; row < size_t{blockSide}; ++row) {
        const uint8_t* const here = bytesOf(a.rows + row * a.stride);
        const uint8_t* const there = bytesOf(b.rows + row * b.stride);
        if (fx == 0 && fy == 0) {
            sum += differenceOfRows(here, there);
        } else {
            std::array<uint8_t, rowBytes> between;
            interpolateRow(there, bytesOf(b.rows + (row + 1) * b.stride), fx, fy, between.data());
            sum += differenceOfRows(here, between.data());
        }
    }
    return sum;
}

/// The blocks of a level.
struct Grid {
    int columns, rows;
    std::vector<Offset> offsets;

    explicit Grid(const GuideLevel& level)
        : columns((level.width + blockDistance - 1) / blockDistance),
          rows((level.height + blockDistance - 1) / blockDistance),
          offsets(static_cast<size_t>(columns) * static_cast<size_t>(rows)) {}

    size_t index(int i, int j) const {
        return static_cast<size_t>(std::clamp(j, 0, rows - 1)) * static_cast<size_t>(columns) +
               static_cast<size_t>(std::clamp(i, 0, columns - 1));
    }
    const Offset& at(int i, int j) const { return offsets[index(i, j)]; }
};

using Nine = std::array<Offset, 9>;

/// A block and eight at this distance.
Nine around(const Grid& grid, int i, int j, int distance) {
    Nine result;
    size_t n = 0;
    for (int v = -1; v <= 1; ++v)
        for (int u = -1; u <= 1; ++u) result[n++] = grid.at(i + u * distance, j + v * distance);
    return result;
}

Offset medianOf(const Nine& offsets) {
    std::array<int, 9> x, y;
    for (size_t i = 0; i < offsets.size(); ++i) {
        x[i] = offsets[i].x;
        y[i] = offsets[i].y;
    }
    std::nth_element(x.begin(), x.begin() + 4, x.end());
    std::nth_element(y.begin(), y.begin() + 4, y.end());
    return {x[4], y[4]};
}

/// Looks for the best motion of one block.
class BlockSearch {
  public:
    BlockSearch(const GuideLevel& now, const GuideLevel& before, int i, int j, const Offset& expected)
        : now_(now),
          before_(before),
          x_(i * blockDistance + blockDistance / 2 - blockSide / 2),
          y_(j * blockDistance + blockDistance / 2 - blockSide / 2),
          expected_(expected) {
        consider(expected);
    }

    void consider(const Offset& offset) {
        if (cost_ >= 0 && offset == best_) return;
        const int difference = blockDifference(now_, before_, x_, y_, offset);
        const int away = std::abs(offset.x - expected_.x) + std::abs(offset.y - expected_.y);
        // Objects differ from what is around them by any amount, so that the penalty has a limit.
        const int cost = difference + (penaltyPerPixel * std::min(away, penaltyReach) +
                                       difference / noiseShare * std::min(away, stepsPerPixel)) /
                                          stepsPerPixel;
        if (cost_ >= 0 && cost >= cost_) return;
        cost_ = cost;
        best_ = offset;
    }

    /// Moves to the best of four neighbours at this distance, until none is better.
    void descend(int distance, int steps) {
        for (int step = 0; step < steps; ++step) {
            const Offset centre = best_;
            for (const Offset& side : {Offset{1, 0}, Offset{-1, 0}, Offset{0, 1}, Offset{0, -1}})
                consider(centre + Offset{side.x * distance, side.y * distance});
            if (best_ == centre) return;
        }
    }

    const Offset& best() const { return best_; }

  private:
    const GuideLevel& now_;
    const GuideLevel& before_;
    int x_, y_;
    Offset expected_, best_;
    int cost_ = -1;
};

template <typename Action>
void forEachBlock(const Grid& grid, Action action) {
    tbb::parallel_for(0, grid.rows, [&](int j) {
        for (int i = 0; i < grid.columns; ++i) action(i, j);
    });
}

void searchCoarsest(const GuideLevel& now, const GuideLevel& before, Grid& grid) {
    forEachBlock(grid, [&](int i, int j) {
        BlockSearch search(now, before, i, j, {});
        for (int y = -coarsestReach; y <= coarsestReach; ++y)
            for (int x = -coarsestReach; x <= coarsestReach; ++x)
                search.consider({x * stepsPerPixel, y * stepsPerPixel});
        grid.offsets[grid.index(i, j)] = search.best();
    });
}

/// Starts with what the coarser level found around each block.
void searchNext(const GuideLevel& now, const GuideLevel& before, const Grid& coarser, Grid& grid) {
    forEachBlock(grid, [&](int i, int j) {
        Nine parents = around(coarser, i / 2, j / 2, 1);
        for (Offset& parent : parents) parent = {2 * parent.x, 2 * parent.y};
        BlockSearch search(now, before, i, j, medianOf(parents));
        search.consider({});
        for (const Offset& parent : parents) search.consider(parent);
        search.descend(stepsPerPixel, 4);
        grid.offsets[grid.index(i, j)] = search.best();
    });
}

/// Lets each block try the motion of blocks at this distance, in blocks.
void agree(const GuideLevel& now, const GuideLevel& before, int distance, Grid& grid) {
    const Grid last = grid;
    forEachBlock(grid, [&](int i, int j) {
        BlockSearch search(now, before, i, j, medianOf(around(last, i, j, 1)));
        for (const Offset& offset : around(last, i, j, distance)) search.consider(offset);
        grid.offsets[grid.index(i, j)] = search.best();
    });
}

/// Looks between pixels; nothing is expected there.
void refine(const GuideLevel& now, const GuideLevel& before, Grid& grid) {
    forEachBlock(grid, [&](int i, int j) {
        Offset& offset = grid.offsets[grid.index(i, j)];
        for (const int distance : {stepsPerPixel / 2, stepsPerPixel / 4, stepsPerPixel / 8}) {
            BlockSearch search(now, before, i, j, offset);
            search.descend(distance, 2);
            offset = search.best();
        }
    });
}

/// How well the block's motion can be told, from 0 to 1: by the direction in which it changes least.
float textureOf(const GuideLevel& level, int i, int j) {
    const int x = i * blockDistance + blockDistance / 2 - blockSide / 2,
              y = j * blockDistance + blockDistance / 2 - blockSide / 2;
    int least = std::numeric_limits<int>::max();
    for (const Offset& side : {Offset{stepsPerPixel, 0}, Offset{0, stepsPerPixel},
                               Offset{stepsPerPixel, stepsPerPixel}, Offset{stepsPerPixel, -stepsPerPixel}})
        least = std::min(least, blockDifference(level, level, x, y, side));
    const auto texture = static_cast<float>(least);
    return texture / (texture + halfTexture);
}

/// Motion with weights, at half the resolution of the level before.
struct Weighted {
    int columns, rows;
    std::vector<vec3> sums;  ///< motion times weight, and the weight

    const vec3& at(int i, int j) const {
        return sums[static_cast<size_t>(std::clamp(j, 0, rows - 1)) * static_cast<size_t>(columns) +
                    static_cast<size_t>(std::clamp(i, 0, columns - 1))];
    }
};

Weighted halved(const Weighted& from) {
    Weighted to{(from.columns + 1) / 2, (from.rows + 1) / 2, {}};
    for (int j = 0; j < to.rows; ++j)
        for (int i = 0; i < to.columns; ++i) {
            vec3 sum(0.0f);
            for (int v = 0; v < 2; ++v)
                for (int u = 0; u < 2; ++u)
                    if (2 * i + u < from.columns && 2 * j + v < from.rows)
                        sum += from.at(2 * i + u, 2 * j + v);
            to.sums.push_back(sum);
        }
    return to;
}

/// Adds to each place what the coarser level has there (interpolated), as far as its own weight is below 1.
void fillFrom(const Weighted& coarser, Weighted& to) {
    for (int j = 0; j < to.rows; ++j)
        for (int i = 0; i < to.columns; ++i) {
            vec3& own =
                to.sums[static_cast<size_t>(j) * static_cast<size_t>(to.columns) + static_cast<size_t>(i)];
            if (own.z >= 1.0f) continue;
            const int a = (i + 1) / 2 - 1, b = (j + 1) / 2 - 1;
            const float fx = i % 2 == 0 ? 0.75f : 0.25f, fy = j % 2 == 0 ? 0.75f : 0.25f;
            const vec3 mean = (1.0f - fx) * (1.0f - fy) * coarser.at(a, b) +
                              fx * (1.0f - fy) * coarser.at(a + 1, b) +
                              (1.0f - fx) * fy * coarser.at(a, b + 1) + fx * fy * coarser.at(a + 1, b + 1);
            if (mean.z > 0.0f) own += mean * ((1.0f - own.z) / mean.z);
        }
}

/// Gives blocks without texture the motion around them, by pulling it down a pyramid and pushing it up again
/// (S. J. Gortler et al., "The Lumigraph", SIGGRAPH 1996).
void fillFlat(const GuideLevel& now, const GuideLevel& before, Grid& grid) {
    std::vector<Weighted> levels(1, {grid.columns, grid.rows, {}});
    levels[0].sums.resize(grid.offsets.size());
    forEachBlock(grid, [&](int i, int j) {
        const size_t n = grid.index(i, j);
        const float texture = textureOf(now, i, j), weight = texture * texture;
        levels[0].sums[n] = vec3(grid.offsets[n].x, grid.offsets[n].y, 1.0f) * weight;
    });
    while (std::max(levels.back().columns, levels.back().rows) > 1) levels.push_back(halved(levels.back()));
    for (size_t level = levels.size() - 1; level-- > 0;) fillFrom(levels[level + 1], levels[level]);
    forEachBlock(grid, [&](int i, int j) {
        const size_t n = grid.index(i, j);
        const vec3 sum = levels[0].sums[n];
        if (!(sum.z > 0.0f)) return;
        const Offset filled{static_cast<int>(std::lround(sum.x / sum.z)),
                            static_cast<int>(std::lround(sum.y / sum.z))};
        const int x = i * blockDistance + blockDistance / 2 - blockSide / 2,
                  y = j * blockDistance + blockDistance / 2 - blockSide / 2;
        const int own = blockDifference(now, before, x, y, grid.offsets[n]);
        if (blockDifference(now, before, x, y, filled) <= own + fillSlack) grid.offsets[n] = filled;
    });
}

}  // namespace

const vec2& MotionField::at(int column, int row) const {
    return motion[static_cast<size_t>(std::clamp(row, 0, rows - 1)) * static_cast<size_t>(columns) +
                  static_cast<size_t>(std::clamp(column, 0, columns - 1))];
}

MotionField matchBlocks(const std::vector<GuideLevel>& now, const std::vector<GuideLevel>& before) {
    Grid grid(now.back());
    searchCoarsest(now.back(), before.back(), grid);
    agree(now.back(), before.back(), 1, grid);
    for (size_t level = now.size() - 1; level-- > 0;) {
        Grid finer(now[level]);
        searchNext(now[level], before[level], grid, finer);
        for (const int distance : {4, 2, 1}) agree(now[level], before[level], distance, finer);
        grid = std::move(finer);
    }
    refine(now.front(), before.front(), grid);
    agree(now.front(), before.front(), 1, grid);
    fillFlat(now.front(), before.front(), grid);
    MotionField field{grid.columns, grid.rows, {}};
    for (const Offset& offset : grid.offsets)
        field.motion.push_back(vec2(offset.x, offset.y) / static_cast<float>(stepsPerPixel));
    return field;
}

}  // namespace limpid::shot
