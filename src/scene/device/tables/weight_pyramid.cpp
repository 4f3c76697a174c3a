#include "scene/device/tables/weight_pyramid.h"

#include <tbb/parallel_for.h>

#include <numeric>
#include <utility>

namespace limpid::scene {
namespace {

/// How many parts a record has in each direction.
struct Parts {
    uint32_t x, y;
};
constexpr Parts ofPicture{2, 2}, ofList{4, 1};

struct PyramidLevel {
    std::vector<double> sums;  ///< of each record
    std::vector<vec4> records;
    uint32_t width = 0, height = 0;
};

/// The level above one whose records have these sums.
PyramidLevel levelAbove(const std::vector<double>& sums, uint32_t width, uint32_t height, Parts parts) {
    PyramidLevel level;
    level.width = (width - 1) / parts.x + 1;
    level.height = (height - 1) / parts.y + 1;
    level.sums.resize(size_t{level.width} * level.height);
    level.records.resize(level.sums.size());
    tbb::parallel_for(0u, level.height, [&](uint32_t y) {
        for (uint32_t x = 0; x < level.width; ++x) {
            const size_t at = size_t{y} * level.width + x;
            for (uint32_t i = 0; i < 4; ++i) {
                const uint32_t column = parts.x * x + i % parts.x, row = parts.y * y + i / parts.x;
                if (column >= width || row >= height) continue;
                const double sum = sums[size_t{row} * width + column];
                level.records[at][static_cast<int>(i)] = static_cast<float>(sum);
                level.sums[at] += sum;
            }
        }
    });
    return level;
}

WeightPyramid build(std::vector<double> weights, uint32_t width, uint32_t height, Parts parts) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double even = 1.0 / static_cast<double>(weights.size());
    WeightPyramid pyramid;
    pyramid.probabilities.reserve(weights.size());
    for (double& weight : weights) {
        weight = sum > 0.0 ? weight / sum : even;
        pyramid.probabilities.push_back(static_cast<float>(weight));
    }
    std::vector<PyramidLevel> levels;
    while (weights.size() > 1) {
        levels.push_back(levelAbove(weights, width, height, parts));
        weights = std::move(levels.back().sums);
        width = levels.back().width;
        height = levels.back().height;
    }
    for (auto level = levels.rbegin(); level != levels.rend(); ++level)
        pyramid.records.insert(pyramid.records.end(), level->records.begin(), level->records.end());
    return pyramid;
}

}  // namespace

WeightPyramid buildWeightPyramid(std::vector<double> weights, uint32_t width, uint32_t height) {
    return build(std::move(weights), width, height, ofPicture);
}

WeightPyramid buildWeightPyramid(std::vector<double> weights) {
    const auto count = static_cast<uint32_t>(weights.size());
    return build(std::move(weights), count, 1, ofList);
}

}  // namespace limpid::scene
