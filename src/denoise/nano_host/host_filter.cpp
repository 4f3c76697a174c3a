#include "denoise/nano_host/host_filter.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/half.h"
#include "neural/exponential.h"

namespace limpid::denoise {
namespace {

using neural::exponential;

/// Bytes of the logits of a band. Few bands: the threads of oneDNN and of TBB take turns, and while oneDNN's
/// wait for its next call, they compute nothing but keep CPUs busy.
constexpr size_t bandBytes = size_t{16} << 20;
constexpr int mostLogits = NANO_FINEST_LOGIT_GROUPS * NANO_GROUP;

constexpr int ownTaps(int reach) {
    return (2 * reach + 1) * (2 * reach + 1);
}

/// The light of one level and of the filtered coarser one, if there is one.
struct Around {
    gpu::Extent extent;
    const HostLight* light;
    const HostLight* coarser;
};

void add(HostLight& sums, const HostLight& light, float diffuse, float specular) {
    for (size_t k = 0; k < 4; ++k) sums[k] += diffuse * light[k];
    for (size_t k = 4; k < 8; ++k) sums[k] += specular * light[k];
}

HostLight meanOf(const HostLight& sums) {
    if (sums[3] <= 0.0f) return {};
    HostLight mean;
    for (size_t k = 0; k < 4; ++k) mean[k] = sums[k] / sums[3];
    for (size_t k = 4; k < 8; ++k) mean[k] = sums[k] / sums[7];
    return mean;
}

/// Of at least four values; four at a time, for compilers to vectorise.
float largest(const float* values, int count) {
    std::array<float, 4> most{values[0], values[1], values[2], values[3]};
    for (int i = 4; i + 4 <= count; i += 4)
        for (size_t k = 0; k < 4; ++k) most[k] = std::max(most[k], values[i + static_cast<int>(k)]);
    for (int i = count / 4 * 4; i < count; ++i) most[0] = std::max(most[0], values[i]);
    return std::max(std::max(most[0], most[1]), std::max(most[2], most[3]));
}

/// The weights of one signal's taps, so that the largest is 1.
template <int groups>
void weigh(const float* logits, int taps, float* weights) {
    const float most = largest(logits, taps);
    // Not 0, even if the only taps that see a surface have small weights. Other logits than of taps may be
    // larger.
    for (int i = 0; i < groups * NANO_GROUP; ++i) weights[i] = std::max(logits[i] - most, -60.0f);
    for (int i = 0; i < groups * NANO_GROUP; ++i) weights[i] = std::min(weights[i], 0.0f);
    for (int i = 0; i < groups * NANO_GROUP; ++i) weights[i] = exponential(weights[i]);
}

template <int reach, int groups>
HostLight filtered(const Around& around, int x, int y, const float* logits) {
    const int width = static_cast<int>(around.extent.width), height = static_cast<int>(around.extent.height);
    const int taps = ownTaps(reach) + (around.coarser ? NANO_COARSER_TAPS : 0);
    std::array<float, mostLogits> diffuse, specular;
    weigh<groups>(logits, taps, diffuse.data());
    weigh<groups>(logits + groups * NANO_GROUP, taps, specular.data());
    HostLight sums{};
    size_t i = 0;
    for (int dy = -reach; dy <= reach; ++dy) {
        const HostLight* row = around.light + size_t{around.extent.width} *
                                                  static_cast<size_t>(std::clamp(y + dy, 0, height - 1));
        for (int dx = -reach; dx <= reach; ++dx, ++i)
            add(sums, row[std::clamp(x + dx, 0, width - 1)], diffuse[i], specular[i]);
    }
    for (int k = 0; around.coarser && k < NANO_COARSER_TAPS; ++k, ++i) {
        const int cx = std::clamp(x / 2 + k % 2 - 1 + (x & 1), 0, width / 2 - 1);
        const int cy = std::clamp(y / 2 + k / 2 - 1 + (y & 1), 0, height / 2 - 1);
        add(sums, around.coarser[cy * (width / 2) + cx], diffuse[i], specular[i]);
    }
    return meanOf(sums);
}

/// The share of the filter's light in the result.
float shareOf(const float* logits) {
    constexpr int own = ownTaps(NANO_FINEST_REACH) + NANO_COARSER_TAPS;
    return 1.0f / (1.0f + std::exp(logits[own + 1] - logits[own]));
}

HostLight unpackLight(const float* values) {
    if (values[6] <= 0.0f) return {};
    return {values[0], values[1], values[2], 1.0f, values[3], values[4], values[5], 1.0f};
}

/// Four sums at a time, for compilers to vectorise.
float dot(const float* a, const float* b, size_t count) {
    std::array<float, 4> sums{};
    for (size_t i = 0; i < count; i += 4)
        for (size_t k = 0; k < 4; ++k) sums[k] += a[i + k] * b[i + k];
    return sums[0] + sums[1] + sums[2] + sums[3];
}

}  // namespace

HostFilter::HostFilter(const NanoNetwork& network, gpu::Extent extent) {
    for (size_t i = 0; i < NANO_LEVELS; ++i) {
        const NanoLayer& shape = network.levels[i].logits;
        const HostLayer layer = readHostLayer(network, shape, 1);
        Level& level = levels_[i];
        level.extent = {extent.width >> i, extent.height >> i};
        level.channels = shape.inputs * NANO_GROUP;
        level.logits = shape.outputs * NANO_GROUP;
        const size_t bytesOfRow = size_t{level.extent.width} * level.logits * sizeof(float);
        level.bandRows = std::clamp(static_cast<uint32_t>(bandBytes / bytesOfRow), 1u, level.extent.height);
        level.light.resize(size_t{level.extent.width} * level.extent.height);
        if (i > 0) level.result.resize(level.light.size());
        level.band.resize(size_t{level.extent.width} * level.bandRows * level.logits);
        level.logitsOfBand.emplace(neural::ConvolutionShape{.inputs = level.channels,
                                                            .outputs = level.logits,
                                                            .columns = level.extent.width,
                                                            .rows = level.bandRows},
                                   layer.weights, layer.biases);
        for (size_t signal = 0; signal < 2; ++signal) {
            const size_t logit = signal * level.logits / 2 + nanoPoolLogit(i);
            level.pool.push_back(layer.biases[logit]);
            const auto first = layer.weights.begin() + static_cast<std::ptrdiff_t>(logit * level.channels);
            level.pool.insert(level.pool.end(), first, first + level.channels);
        }
    }
}

void HostFilter::run(const HostLayers& layers, const NanoTile& tile, std::span<const uint16_t> light,
                     std::span<float> result) {
    Level& finest = levels_[0];
    if (light.size() < 8 * finest.light.size() ||
        result.size() < 8 * size_t{tile.extent.width} * tile.inner.height)
        throw Error("the light of a network's tile is smaller than the tile");
    tbb::parallel_for(0u, finest.extent.height, [&](uint32_t y) {
        std::array<float, 8> values{};
        const size_t row = size_t{y} * finest.extent.width;
        for (size_t i = row; i < row + finest.extent.width; ++i) {
            toFloats(light.subspan(8 * i, 8), values);
            finest.light[i] = unpackLight(values.data());
        }
    });
    for (size_t i = 0; i + 1 < NANO_LEVELS; ++i) pool(i, layers.channels(i));
    for (size_t i = NANO_LEVELS - 1; i > 0; --i) filter(i, layers.channels(i));
    filterFinest(layers.channels(0), tile, result);
}

void HostFilter::pool(size_t i, std::span<const float> channels) {
    const Level& fine = levels_[i];
    Level& coarse = levels_[i + 1];
    const size_t width = fine.extent.width, count = fine.channels;
    const float *diffuse = fine.pool.data(), *specular = diffuse + 1 + count;
    const auto weight = [&](const float* signal, const float* x) {
        return std::exp(std::clamp(signal[0] + dot(signal + 1, x, count), -10.0f, 10.0f));
    };
    tbb::parallel_for(0u, coarse.extent.height, [&](uint32_t y) {
        for (size_t x = 0; x < coarse.extent.width; ++x) {
            HostLight sums{};
            for (const size_t pixel : {2 * y * width + 2 * x, 2 * y * width + 2 * x + 1,
                                       (2 * y + 1) * width + 2 * x, (2 * y + 1) * width + 2 * x + 1}) {
                const float* of = &channels[pixel * count];
                add(sums, fine.light[pixel], weight(diffuse, of), weight(specular, of));
            }
            coarse.light[size_t{y} * coarse.extent.width + x] = meanOf(sums);
        }
    });
}

uint32_t HostFilter::makeBand(Level& level, std::span<const float> channels, uint32_t top) {
    const uint32_t first = std::min(top, level.extent.height - level.bandRows);
    const size_t row = size_t{level.extent.width} * level.channels;
    level.logitsOfBand->run(channels.subspan(first * row, level.bandRows * row), level.band);
    return first;
}

void HostFilter::filter(size_t i, std::span<const float> channels) {
    Level& level = levels_[i];
    const Around around{level.extent, level.light.data(),
                        i + 1 < NANO_LEVELS ? levels_[i + 1].result.data() : nullptr};
    const size_t width = level.extent.width;
    for (uint32_t top = 0; top < level.extent.height; top += level.bandRows) {
        const uint32_t first = makeBand(level, channels, top);
        tbb::parallel_for(top, std::min(top + level.bandRows, level.extent.height), [&](uint32_t y) {
            const float* logits = &level.band[(y - first) * width * level.logits];
            for (size_t x = 0; x < width; ++x, logits += level.logits)
                level.result[y * width + x] = filtered<NANO_REACH, NANO_LOGIT_GROUPS>(
                    around, static_cast<int>(x), static_cast<int>(y), logits);
        });
    }
}

void HostFilter::filterFinest(std::span<const float> channels, const NanoTile& tile,
                              std::span<float> result) {
    Level& level = levels_[0];
    const Around around{level.extent, level.light.data(), levels_[1].result.data()};
    const uint32_t left = tile.innerX - tile.x, top = tile.innerY - tile.y, bottom = top + tile.inner.height;
    for (uint32_t begin = top; begin < bottom; begin += level.bandRows) {
        const uint32_t first = makeBand(level, channels, begin);
        tbb::parallel_for(begin, std::min(begin + level.bandRows, bottom), [&](uint32_t y) {
            for (uint32_t x = left; x < left + tile.inner.width; ++x) {
                const float* logits =
                    &level.band[((y - first) * size_t{level.extent.width} + x) * level.logits];
                const HostLight own = filtered<NANO_FINEST_REACH, NANO_FINEST_LOGIT_GROUPS>(
                    around, static_cast<int>(x), static_cast<int>(y), logits);
                float* out = &result[8 * ((y - top) * size_t{level.extent.width} + x - left)];
                std::ranges::copy(own, out);
                out[3] = shareOf(logits);
                out[7] = shareOf(logits + level.logits / 2);
            }
        });
    }
}

}  // namespace limpid::denoise
