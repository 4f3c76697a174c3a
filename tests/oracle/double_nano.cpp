#include "tests/oracle/double_nano.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "base/error.h"

namespace limpid::test {
namespace {

constexpr size_t levelCount = 5;
constexpr std::array<int64_t, levelCount> kernelEdges{5, 3, 3, 3, 3};
constexpr size_t featureCount = 24;
constexpr int64_t multiple = 16;  ///< of pixels, to which pictures are padded

// ------------------------------------------------------------------------------------------------ network

/// The weights are in the order tap, input, output.
struct Layer {
    size_t inputs, outputs;
    int64_t edge;  ///< taps of a row
    std::vector<double> biases, weights;
};

struct Level {
    Layer halve;  ///< from the next finer level, or from the features
    std::vector<Layer> around;
    Layer join, after;  ///< none at the coarsest level
    Layer logits;
};

/// Reads layers one after another.
class Weights {
  public:
    explicit Weights(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// Texels of eight halves: biases; then for each tap, eight inputs and eight outputs a block of 8x8.
    Layer next(size_t inputs, size_t outputs, int64_t edge) {
        const auto taps = static_cast<size_t>(edge * edge);
        Layer layer{inputs, outputs, edge, {}, std::vector<double>(taps * inputs * outputs)};
        for (size_t o = 0; o < outputs; ++o) layer.biases.push_back(nextHalf());
        for (size_t tap = 0; tap < taps; ++tap) {
            for (size_t block = 0; block < inputs * outputs / 64; ++block) {
                const size_t i = block / (outputs / 8) * 8, o = block % (outputs / 8) * 8;
                for (size_t n = 0; n < 64; ++n)
                    layer.weights[(tap * inputs + i + n / 8) * outputs + o + n % 8] = nextHalf();
            }
        }
        return layer;
    }
    /// Behind the last layer there is only what fills the last row.
    bool atEnd() const {
        return std::ranges::all_of(bytes_, [](std::byte byte) { return byte == std::byte{0}; });
    }

  private:
    double nextHalf() {
        uint16_t half = 0;
        if (bytes_.size() < sizeof(half)) throw Error("too few weights");
        std::memcpy(&half, bytes_.data(), sizeof(half));
        bytes_ = bytes_.subspan(sizeof(half));
        return glm::unpackHalf1x16(half);
    }

    std::span<const std::byte> bytes_;
};

/// For both signals.
size_t logitsAt(size_t level) {
    return level == 0 ? 64 : 32;
}

std::array<Level, levelCount> networkOf(const NanoShapeOf& shape, std::span<const std::byte> bytes) {
    const auto& [widths, depths] = shape;
    Weights weights(bytes);
    std::array<Level, levelCount> levels;
    for (size_t i = 0; i < levelCount; ++i) {
        levels[i].halve =
            i == 0 ? weights.next(featureCount, widths[0], 1) : weights.next(widths[i - 1], widths[i], 2);
        for (size_t n = 0; n < depths[i]; ++n)
            levels[i].around.push_back(weights.next(widths[i], widths[i], 3));
    }
    for (size_t i = 0; i < levelCount; ++i) {
        if (i + 1 < levelCount) {
            levels[i].join = weights.next(widths[i] + widths[i + 1], widths[i], 1);
            levels[i].after = weights.next(widths[i], widths[i], 3);
        }
        levels[i].logits = weights.next(widths[i], logitsAt(i), 1);
    }
    if (!weights.atEnd()) throw Error("too many weights");
    return levels;
}

/// Numbers of pixels, those of a pixel side by side.
struct Map {
    int64_t width, height;
    size_t channels;
    std::vector<double> values;

    Map(int64_t columns, int64_t rows, size_t count)
        : width(columns),
          height(rows),
          channels(count),
          values(static_cast<size_t>(columns * rows) * count) {}
    double* at(int64_t x, int64_t y) { return &values[static_cast<size_t>(y * width + x) * channels]; }
    const double* at(int64_t x, int64_t y) const {
        return &values[static_cast<size_t>(y * width + x) * channels];
    }
    bool contains(int64_t x, int64_t y) const { return x >= 0 && y >= 0 && x < width && y < height; }
};

/// Adds what one tap contributes to all outputs of a pixel.
void addTap(const Layer& layer, size_t tap, const double* inputs, double* sums) {
    const double* weight = &layer.weights[tap * layer.inputs * layer.outputs];
    for (size_t i = 0; i < layer.inputs; ++i)
        for (size_t o = 0; o < layer.outputs; ++o) sums[o] += inputs[i] * *weight++;
}

/// A convolution: 1x1, 3x3 with zeros beyond the edges, or 2x2 of the next finer level.
Map convolve(const Map& inputs, const Layer& layer) {
    const int64_t stride = layer.edge == 2 ? 2 : 1, before = layer.edge == 3 ? 1 : 0;
    Map outputs(inputs.width / stride, inputs.height / stride, layer.outputs);
    for (int64_t y = 0; y < outputs.height; ++y) {
        for (int64_t x = 0; x < outputs.width; ++x) {
            double* const sums = outputs.at(x, y);
            std::ranges::copy(layer.biases, sums);
            for (int64_t tap = 0; tap < layer.edge * layer.edge; ++tap) {
                const int64_t tapX = stride * x + tap % layer.edge - before;
                const int64_t tapY = stride * y + tap / layer.edge - before;
                if (inputs.contains(tapX, tapY))
                    addTap(layer, static_cast<size_t>(tap), inputs.at(tapX, tapY), sums);
            }
        }
    }
    return outputs;
}

/// Every layer but the logits has an activation.
Map activated(Map map) {
    for (double& x : map.values) x = x > 0.0 ? x : 0.1 * x;
    return map;
}

/// The channels of `own`, then those of the nearest pixel of the coarser level.
Map concatenated(const Map& own, const Map& coarser) {
    Map both(own.width, own.height, own.channels + coarser.channels);
    for (int64_t y = 0; y < own.height; ++y) {
        for (int64_t x = 0; x < own.width; ++x) {
            double* const to = both.at(x, y);
            std::copy_n(own.at(x, y), own.channels, to);
            std::copy_n(coarser.at(x / 2, y / 2), coarser.channels, to + own.channels);
        }
    }
    return both;
}

/// The logits of every level.
std::vector<Map> runNetwork(Map channels, const std::array<Level, levelCount>& levels) {
    std::vector<Map> kept, logits;
    for (const Level& level : levels) {
        channels = activated(convolve(channels, level.halve));
        for (const Layer& layer : level.around) channels = activated(convolve(channels, layer));
        kept.push_back(channels);
    }
    for (size_t i = levelCount - 1; i-- > 0;) {
        const Map joined = activated(convolve(concatenated(kept[i], kept[i + 1]), levels[i].join));
        kept[i] = activated(convolve(joined, levels[i].after));
    }
    for (size_t i = 0; i < levelCount; ++i) logits.push_back(convolve(kept[i], levels[i].logits));
    return logits;
}

// ----------------------------------------------------------------------------------------------- features

/// Reads a frame as if the pixels at its edges were repeated for ever.
class Padded {
  public:
    explicit Padded(const NanoFrame& frame) : frame_(frame) {}

    int64_t width() const { return (frame_.width + multiple - 1) / multiple * multiple; }
    int64_t height() const { return (frame_.height + multiple - 1) / multiple * multiple; }
    size_t pixel(int64_t x, int64_t y) const {
        const int64_t column = std::clamp<int64_t>(x, 0, int64_t{frame_.width} - 1);
        const int64_t row = std::clamp<int64_t>(y, 0, int64_t{frame_.height} - 1);
        return static_cast<size_t>(row * frame_.width + column);
    }
    bool sees(int64_t x, int64_t y) const { return frame_.surfaces.distance[pixel(x, y)] > 0.0; }
    double logDistance(int64_t x, int64_t y) const {
        return std::log2(frame_.surfaces.distance[pixel(x, y)] + 0.01);
    }

    /// Of a pixel of the frame.
    std::array<double, featureCount> features(int64_t x, int64_t y) const;

  private:
    const NanoFrame& frame_;
};

/// What the network sees of one signal.
struct SignalFeatures {
    double accumulated = 0.0, filtered = 0.0, first = 0.0, past = 0.0, deviation = 0.0, frames = 0.0;
};

/// Negative light counts as black.
double seenLuminance(const dvec3& light) {
    return luminance(glm::max(light, dvec3(0.0)));
}

SignalFeatures signalFeatures(const NanoSignal& s, size_t p) {
    return {.accumulated = seenLuminance(dvec3(s.accumulated[p])),
            .filtered = seenLuminance(dvec3(s.filtered[p])),
            .first = seenLuminance(dvec3(s.first[p])),
            .past = seenLuminance(s.past.empty() ? dvec3(s.filtered[p]) : s.past[p]),
            .deviation = std::max(s.accumulated[p].w, 0.0),
            .frames = s.frames[p]};
}

double logarithm(double x) {
    return std::log2(x + 0.01) * 0.2;
}

std::array<double, featureCount> Padded::features(int64_t x, int64_t y) const {
    const size_t p = pixel(x, y);
    std::array<SignalFeatures, 2> both;
    both[1].frames = frame_.signals[0].frames[p];
    for (size_t s = 0; s < frame_.signals.size(); ++s) both[s] = signalFeatures(frame_.signals[s], p);
    std::array<double, featureCount> result{};
    for (size_t s = 0; s < 2; ++s) {
        const SignalFeatures& f = both[s];
        result[0 + s] = logarithm(f.accumulated);
        result[2 + s] = logarithm(f.filtered);
        result[4 + s] = logarithm(f.first);
        result[6 + s] = logarithm(f.past);
        result[8 + s] = std::clamp((f.accumulated - f.filtered) / (f.filtered + 0.02), -2.0, 2.0);
        result[10 + s] = std::min(f.deviation / (f.filtered + 0.02), 4.0) * 0.5;
        result[12 + s] = 1.0 / std::max(f.frames, 1.0);
    }
    const double d = logDistance(x, y);
    const double around =
        logDistance(x - 1, y) + logDistance(x + 1, y) + logDistance(x, y - 1) + logDistance(x, y + 1);
    result[21] = d * 0.25;
    result[22] = std::clamp(4.0 * d - around, -1.0, 1.0) * 4.0;
    if (!sees(x, y)) return result;
    const dvec3 albedo = glm::clamp(frame_.signals[0].albedo[p], 0.0, 1.0);
    const dvec3 normal = frame_.surfaces.normal[p];
    for (int c = 0; c < 3; ++c) result[static_cast<size_t>(14 + c)] = albedo[c];
    if (frame_.signals.size() > 1) result[17] = luminance(glm::clamp(frame_.signals[1].albedo[p], 0.0, 1.0));
    result[18] = glm::dot(normal, glm::normalize(dvec3(frame_.camera.right)));
    result[19] = glm::dot(normal, glm::normalize(dvec3(frame_.camera.up)));
    result[20] = -glm::dot(normal, glm::normalize(dvec3(frame_.camera.forward)));
    result[23] = frame_.surfaces.roughness[p];
    return result;
}

/// The features are repeated beyond the edges, not what they are computed from.
Map featuresOf(const Padded& padded, const NanoFrame& frame) {
    Map map(padded.width(), padded.height(), featureCount);
    for (int64_t y = 0; y < map.height; ++y) {
        for (int64_t x = 0; x < map.width; ++x) {
            const int64_t column = std::min(x, int64_t{frame.width} - 1);
            const int64_t row = std::min(y, int64_t{frame.height} - 1);
            std::ranges::copy(padded.features(column, row), map.at(x, y));
        }
    }
    return map;
}

// ------------------------------------------------------------------------------------------------- filter

/// Light of a pixel of one signal. Where no surface is seen it does not count.
struct Texel {
    dvec3 light{0.0}, spread{0.0};
    bool sees = false;
};

struct Lights {
    int64_t width, height;
    std::vector<Texel> texels;

    Lights(int64_t columns, int64_t rows)
        : width(columns), height(rows), texels(static_cast<size_t>(columns * rows)) {}
    Texel& at(int64_t x, int64_t y) { return texels[static_cast<size_t>(y * width + x)]; }
    const Texel& nearest(int64_t x, int64_t y) const {
        return texels[static_cast<size_t>(std::clamp<int64_t>(y, 0, height - 1) * width +
                                          std::clamp<int64_t>(x, 0, width - 1))];
    }
};

/// The mean of texels, weighted by the exponentials of their logits.
Texel meanOf(const std::vector<Texel>& texels, const double* logits) {
    double most = -HUGE_VAL, weights = 0.0;
    for (size_t i = 0; i < texels.size(); ++i)
        if (texels[i].sees) most = std::max(most, logits[i]);
    Texel mean;
    for (size_t i = 0; i < texels.size(); ++i) {
        if (!texels[i].sees) continue;
        mean.light += std::exp(logits[i] - most) * texels[i].light;
        weights += std::exp(logits[i] - most);
    }
    if (weights <= 0.0) return mean;
    mean.sees = true;
    mean.light /= weights;
    for (size_t i = 0; i < texels.size(); ++i) {
        if (!texels[i].sees) continue;
        const dvec3 moves = glm::abs(texels[i].light - mean.light) + texels[i].spread;
        mean.spread += std::exp(logits[i] - most) / weights * moves;
    }
    return mean;
}

/// The number of logits of a signal that weigh taps.
size_t tapsAt(size_t level) {
    return static_cast<size_t>(kernelEdges[level] * kernelEdges[level]) + (level + 1 < levelCount ? 4 : 0);
}

const double* logitsOf(const Map& logits, size_t signal, int64_t x, int64_t y) {
    return logits.at(x, y) + signal * logits.channels / 2;
}

/// The light of the next coarser level. A signal's last logit is the weight.
Lights pooled(const Lights& light, const Map& logits, size_t signal, size_t level) {
    const size_t number = tapsAt(level) + (level == 0 ? 2 : 0);
    Lights result(light.width / 2, light.height / 2);
    for (int64_t y = 0; y < result.height; ++y) {
        for (int64_t x = 0; x < result.width; ++x) {
            std::vector<Texel> texels;
            std::vector<double> weights;
            for (int64_t i = 0; i < 4; ++i) {
                texels.push_back(light.nearest(2 * x + i % 2, 2 * y + i / 2));
                const double weight = logitsOf(logits, signal, 2 * x + i % 2, 2 * y + i / 2)[number];
                weights.push_back(std::clamp(weight, -10.0, 10.0));
            }
            result.at(x, y) = meanOf(texels, weights.data());
        }
    }
    return result;
}

/// `coarser`: null at the coarsest level.
Lights filtered(const Lights& light, const Lights* coarser, const Map& logits, size_t signal, size_t level) {
    const int64_t edge = kernelEdges[level], reach = edge / 2;
    Lights result(light.width, light.height);
    for (int64_t y = 0; y < light.height; ++y) {
        for (int64_t x = 0; x < light.width; ++x) {
            std::vector<Texel> taps;
            for (int64_t i = 0; i < edge * edge; ++i)
                taps.push_back(light.nearest(x + i % edge - reach, y + i / edge - reach));
            // The four coarse pixels whose centres are nearest.
            for (int64_t i = 0; coarser && i < 4; ++i)
                taps.push_back(coarser->nearest(x / 2 - 1 + x % 2 + i % 2, y / 2 - 1 + y % 2 + i / 2));
            result.at(x, y) = meanOf(taps, logitsOf(logits, signal, x, y));
        }
    }
    return result;
}

/// The filter's light on the finest level.
Lights filteredLight(const Padded& padded, const NanoSignal& signal, const std::vector<Map>& logits,
                     size_t number) {
    std::vector<Lights> lights{Lights(padded.width(), padded.height())};
    for (int64_t y = 0; y < padded.height(); ++y) {
        for (int64_t x = 0; x < padded.width(); ++x) {
            const dvec3 light(signal.accumulated[padded.pixel(x, y)]);
            lights[0].at(x, y) = {.light = glm::max(light, dvec3(0.0)), .sees = padded.sees(x, y)};
        }
    }
    for (size_t i = 0; i + 1 < levelCount; ++i) lights.push_back(pooled(lights[i], logits[i], number, i));
    Lights result = filtered(lights.back(), nullptr, logits.back(), number, levelCount - 1);
    for (size_t i = levelCount - 1; i-- > 0;) result = filtered(lights[i], &result, logits[i], number, i);
    return result;
}

}  // namespace

std::array<NanoLight, 2> nanoFilter(const NanoFrame& frame, const NanoShapeOf& shape,
                                    std::span<const std::byte> weights) {
    const Padded padded(frame);
    const std::vector<Map> logits = runNetwork(featuresOf(padded, frame), networkOf(shape, weights));
    std::array<NanoLight, 2> result;
    for (size_t s = 0; s < frame.signals.size(); ++s) {
        const NanoSignal& signal = frame.signals[s];
        const Lights own = filteredLight(padded, signal, logits, s);
        for (size_t p = 0; p < signal.filtered.size(); ++p) {
            const auto x = static_cast<int64_t>(p % frame.width), y = static_cast<int64_t>(p / frame.width);
            const double* const shares = logitsOf(logits[0], s, x, y) + tapsAt(0);
            const double share = frame.strength / (1.0 + std::exp(shares[1] - shares[0]));
            const Texel& texel = own.nearest(x, y);
            const dvec3 svgf(signal.filtered[p]), moves = share * (texel.light - svgf);
            result[s].light.push_back(padded.sees(x, y) ? svgf + moves : svgf);
            // The share has two logits.
            result[s].spread.push_back(2.0 * glm::abs(moves) + share * texel.spread);
        }
    }
    return result;
}

}  // namespace limpid::test
