#include "denoise/nano_host/host_layers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "base/half.h"

namespace limpid::denoise {
namespace {

using neural::ChannelsLastConvolution;

constexpr float slope = 0.1f;  ///< leaky() of nano_storage.glsl

uint32_t channelsOf(uint32_t groups) {
    return groups * NANO_GROUP;
}

gpu::Extent extentOf(gpu::Extent finest, size_t level) {
    return {finest.width >> level, finest.height >> level};
}

size_t pixelsOf(gpu::Extent extent) {
    return size_t{extent.width} * extent.height;
}

ChannelsLastConvolution make(uint32_t inputs, uint32_t outputs, uint32_t taps, uint32_t stride,
                             gpu::Extent extent, const HostLayer& layer) {
    return {{.inputs = channelsOf(inputs),
             .outputs = channelsOf(outputs),
             .taps = taps,
             .stride = stride,
             .columns = extent.width,
             .rows = extent.height,
             .slope = slope},
            layer.weights,
            layer.biases};
}

/// Each pixel of `from` becomes 2x2 pixels of `to`, which has this size.
void enlarge(std::span<const float> from, std::span<float> to, gpu::Extent extent, size_t channels) {
    tbb::parallel_for(0u, extent.height, [&](uint32_t y) {
        const float* in = &from[size_t{y / 2} * (extent.width / 2) * channels];
        float* out = &to[size_t{y} * extent.width * channels];
        for (uint32_t x = 0; x < extent.width / 2; ++x, in += channels, out += 2 * channels) {
            std::copy_n(in, channels, out);
            std::copy_n(in, channels, out + channels);
        }
    });
}

}  // namespace

HostLayer readHostLayer(const NanoNetwork& network, const NanoLayer& layer, uint32_t taps) {
    size_t at = size_t{layer.weights} * NANO_GROUP * sizeof(uint16_t);
    const auto next = [&] {
        uint16_t half = 0;
        std::memcpy(&half, &network.weights[at], sizeof(half));
        at += sizeof(half);
        return halfToFloat(half);
    };
    const size_t inputs = channelsOf(layer.inputs), others = channelsOf(layer.coarser),
                 square = size_t{taps} * taps;
    const size_t outputs = channelsOf(layer.outputs);
    HostLayer result{
        std::vector<float>(outputs * inputs * square), std::vector<float>(outputs * others * square), {}};
    for (size_t o = 0; o < outputs; ++o) result.biases.push_back(next());
    for (size_t tap = 0; tap < square; ++tap) {
        for (size_t block = 0; block < (inputs + others) * layer.outputs; ++block) {
            const size_t group = block / NANO_GROUP / layer.outputs,
                         input = group * NANO_GROUP + block % NANO_GROUP;
            const size_t first = block / NANO_GROUP % layer.outputs * NANO_GROUP;
            for (size_t o = first; o < first + NANO_GROUP; ++o) {
                const bool own = input < inputs;
                std::vector<float>& weights = own ? result.weights : result.coarser;
                const size_t number = own ? o * inputs + input : o * others + input - inputs;
                weights[number * square + tap] = next();
            }
        }
    }
    return result;
}

HostLayers::HostLayers(const NanoNetwork& network, gpu::Extent extent) {
    for (size_t i = 0; i < NANO_LEVELS; ++i) {
        const size_t size = pixelsOf(extentOf(extent, i)) * channelsOf(network.levels[i].halve.outputs);
        levels_[i].extent = extentOf(extent, i);
        levels_[i].kept.resize(size);
        levels_[i].spare.resize(size);
        makeDown(network, i);
        if (i + 1 < NANO_LEVELS) makeUp(network, i);
    }
}

void HostLayers::makeDown(const NanoNetwork& network, size_t i) {
    const NanoLevel& shape = network.levels[i];
    Level& level = levels_[i];
    if (i > 0)
        level.halve = make(shape.halve.inputs, shape.halve.outputs, 2, 2, levels_[i - 1].extent,
                           readHostLayer(network, shape.halve, 2));
    for (const NanoLayer& around : shape.around)
        level.around.push_back(
            make(around.inputs, around.outputs, 3, 1, level.extent, readHostLayer(network, around, 3)));
}

/// The product of the coarser level's channels, which is the same for 2x2 pixels, is made in its size.
void HostLayers::makeUp(const NanoNetwork& network, size_t i) {
    const NanoLevel& shape = network.levels[i];
    Level& level = levels_[i];
    const HostLayer join = readHostLayer(network, shape.join, 1);
    const gpu::Extent half = extentOf(level.extent, 1);
    const uint32_t outputs = channelsOf(shape.join.outputs);
    level.coarser.resize(pixelsOf(half) * outputs);
    level.fromCoarser.emplace(neural::ConvolutionShape{.inputs = channelsOf(shape.join.coarser),
                                                       .outputs = outputs,
                                                       .columns = half.width,
                                                       .rows = half.height},
                              join.coarser, std::span<const float>());
    level.join.emplace(neural::ConvolutionShape{.inputs = channelsOf(shape.join.inputs),
                                                .outputs = outputs,
                                                .columns = level.extent.width,
                                                .rows = level.extent.height,
                                                .adds = true,
                                                .slope = slope},
                       join.weights, join.biases);
    level.after = make(shape.after.inputs, shape.after.outputs, 3, 1, level.extent,
                       readHostLayer(network, shape.after, 3));
}

void HostLayers::run(std::span<const uint16_t> channels) {
    std::vector<float>& finest = levels_[0].kept;
    if (channels.size() < finest.size()) throw Error("a network's channels are fewer than its tile's");
    const size_t row = finest.size() / levels_[0].extent.height;
    tbb::parallel_for(0u, levels_[0].extent.height, [&](uint32_t y) {
        toFloats(channels.subspan(y * row, row), std::span(finest).subspan(y * row, row));
    });
    for (size_t i = 0; i < NANO_LEVELS; ++i) {
        Level& level = levels_[i];
        if (i > 0) level.halve->run(levels_[i - 1].kept, level.kept);
        for (ChannelsLastConvolution& around : level.around) {
            around.run(level.kept, level.spare);
            std::swap(level.kept, level.spare);
        }
    }
    for (size_t i = NANO_LEVELS - 1; i-- > 0;) up(i);
}

void HostLayers::up(size_t i) {
    Level& level = levels_[i];
    level.fromCoarser->run(levels_[i + 1].kept, level.coarser);
    enlarge(level.coarser, level.spare, level.extent, level.kept.size() / pixelsOf(level.extent));
    level.join->run(level.kept, level.spare);
    level.after->run(level.spare, level.kept);
}

}  // namespace limpid::denoise
