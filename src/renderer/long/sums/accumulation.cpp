#include "renderer/long/sums/accumulation.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "shaders/common/scene_layout.h"

namespace limpid {
namespace {

std::vector<LayerSums> layersFor(const std::vector<std::string>& names) {
    if (names.empty()) return {{.info = &beautyLayer, .squares = false, .values = {}}};
    const auto wants = [&](const LayerInfo& layer) {
        return std::find(names.begin(), names.end(), layer.name) != names.end();
    };
    std::vector<LayerSums> layers;
    for (const LayerInfo& layer : frameLayers) {
        const bool squares = wants(varianceLayer) && layer.varianceInFiles;
        if (layer.isMean() && (layer.inBeauty || squares || wants(layer)))
            layers.push_back({.info = &layer, .squares = squares, .values = {}});
    }
    return layers;
}

/// Returns the square of the quantity whose variance is stored. Uses the shader's float32 weights.
template <typename T>
T squareOf(VarianceOf varianceOf, T x, T y, T z) {
    if (varianceOf == VarianceOf::FirstComponent) return x * x;
    if (varianceOf == VarianceOf::MeanOfComponents) return (x * x + y * y + z * z) / T{3};
    const T luminance = T{0.2126f} * x + T{0.7152f} * y + T{0.0722f} * z;
    return luminance * luminance;
}

/// Clamps `value` to +-limit; NaN becomes 0. Counts changed values.
double clamped(double value, double limit, uint64_t& count) {
    if (std::abs(value) <= limit) return value;
    ++count;
    return std::isnan(value) ? 0.0 : std::copysign(limit, value);
}

/// Adds one pixel's means of `samples` samples; returns how many were clamped.
uint64_t addPixel(const LayerSums& layer, const float* means, double samples, Int128* sums) {
    uint64_t changed = 0;
    std::array<double, 4> mean{};
    for (size_t c = 0; c < layer.info->meanComponents(); ++c) {
        mean[c] = clamped(double{means[c]}, meanLimit, changed);
        sums[c] = addFixed(sums[c], toFixed(mean[c] * samples, meanFraction));
    }
    if (!layer.squares) return changed;
    const double deviation = clamped(std::max(double{means[3]}, 0.0), squareLimit, changed);
    const double square =
        clamped(squareOf(layer.info->varianceOf, mean[0], mean[1], mean[2]), squareLimit, changed);
    Int128& sum = sums[layer.info->meanComponents()];
    sum = addFixed(sum, toFixed(deviation * samples, squareFraction));
    sum = addFixed(sum, toFixed(square * samples, squareFraction));
    return changed;
}

using Range = tbb::blocked_range<size_t>;

uint64_t addLayer(LayerSums& layer, const std::vector<float>& means, uint64_t pixels, uint32_t samples) {
    if (means.size() != pixels * 4)
        throw Error(
            fmt::format("the layer {} has {} values for {} pixels", layer.info->name, means.size(), pixels));
    const size_t planes = layer.planes();
    layer.values.resize(pixels * planes);
    const auto addRange = [&](const Range& range, uint64_t changed) {
        for (size_t p = range.begin(); p < range.end(); ++p)
            changed += addPixel(layer, &means[p * 4], samples, &layer.values[p * planes]);
        return changed;
    };
    return tbb::parallel_reduce(Range(0, pixels, 4096), uint64_t{0}, addRange, std::plus<>());
}

/// Returns four floats: the means, and in the fourth the mean squared deviation if squares were summed.
void meanOfPixel(const LayerSums& layer, const Int128* sums, long double samples, float* result) {
    std::array<long double, 4> mean{};
    for (size_t c = 0; c < layer.info->meanComponents(); ++c) {
        mean[c] = fromFixed(sums[c], meanFraction) / samples;
        result[c] = static_cast<float>(mean[c]);
    }
    if (!layer.squares) return;
    const long double square = fromFixed(sums[layer.info->meanComponents()], squareFraction) / samples;
    const long double ofMean = squareOf(layer.info->varianceOf, mean[0], mean[1], mean[2]);
    result[3] = static_cast<float>(std::max(square - ofMean, 0.0L));
}

}  // namespace

SampleCounts& SampleCounts::operator+=(const SampleCounts& other) {
    rays += other.rays;
    rejected += other.rejected;
    clamped += other.clamped;
    return *this;
}

FrameSums::FrameSums(gpu::Extent size, const BlockPlan& blockPlan, const std::vector<std::string>& layerNames)
    : extent(size),
      plan(blockPlan),
      layers(layersFor(layerNames)),
      blocks(blockPlan.blocks()),
      wantsIds(std::find(layerNames.begin(), layerNames.end(), "id") != layerNames.end()) {}

uint32_t FrameSums::blockCount() const {
    return static_cast<uint32_t>(std::count(blocks.begin(), blocks.end(), true));
}

uint64_t FrameSums::samples() const {
    uint64_t sum = partSamples;
    for (uint32_t block = 0; block < blocks.size(); ++block) {
        if (blocks[block]) sum += plan.samplesOf(block);
    }
    return sum;
}

void FrameSums::add(uint32_t samples, const MeansOf& meansOf) {
    if (partSamples > 0) throw Error("nothing can be added to sums that end in a part of a block");
    for (LayerSums& layer : layers)
        counts.clamped += addLayer(layer, meansOf(*layer.info), pixels(), samples);
}

void FrameSums::addBlock(uint32_t block, const MeansOf& meansOf) {
    if (blocks.at(block)) throw Error(fmt::format("block {} is in the sums already", block));
    add(plan.samplesOf(block), meansOf);
    blocks[block] = true;
}

void FrameSums::addPart(uint32_t samples, const MeansOf& meansOf) {
    add(samples, meansOf);
    partSamples = samples;
}

void FrameSums::merge(const FrameSums& other) {
    if (extent != other.extent || plan != other.plan || layers.size() != other.layers.size())
        throw Error("sums of different renders cannot be merged");
    for (uint32_t block = 0; block < blocks.size(); ++block) {
        if (blocks[block] && other.blocks[block]) throw Error(fmt::format("block {} is in both sums", block));
    }
    for (size_t i = 0; i < layers.size() && other.blockCount() > 0; ++i) {
        layers[i].values.resize(other.layers[i].values.size());
        std::transform(layers[i].values.begin(), layers[i].values.end(), other.layers[i].values.begin(),
                       layers[i].values.begin(), addFixed);
    }
    for (uint32_t block = 0; block < blocks.size(); ++block) {
        if (other.blocks[block]) blocks[block] = true;
    }
    if (!other.ids.empty()) ids = other.ids;
    counts += other.counts;
}

RenderedLayers FrameSums::means() const {
    RenderedLayers result;
    result.extent = extent;
    result.samples = samples();
    if (result.samples == 0) throw Error("nothing has been rendered yet");
    for (const LayerSums& layer : layers) {
        std::vector<float>& texels = result[*layer.info];
        texels.resize(pixels() * 4);
        tbb::parallel_for(Range(0, pixels(), 4096), [&](const Range& range) {
            for (size_t p = range.begin(); p < range.end(); ++p)
                meanOfPixel(layer, &layer.values[p * layer.planes()],
                            static_cast<long double>(result.samples), &texels[p * 4]);
        });
    }
    result.ids = ids;
    // Only block 0 contains them, and it may be missing.
    if (wantsIds && ids.empty()) result.ids.assign(pixels() * 2, layout::NONE);
    return result;
}

}  // namespace limpid
