#include "denoise/kpcn/kpcn_host.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "denoise/kpcn/kpcn_params.h"
#ifdef LIMPID_HAVE_ONEDNN
#include <tbb/parallel_for.h>

#include "neural/convolutions.h"
#include "neural/exponential.h"
#endif

namespace limpid::denoise {

#ifndef LIMPID_HAVE_ONEDNN

struct KpcnHost::Impl {};

bool kpcnHostAvailable() {
    return false;
}
KpcnHost::KpcnHost(const KpcnWeights&) {
    throw Error("Limpid was built without oneDNN");
}
KpcnHost::~KpcnHost() = default;
void KpcnHost::run(size_t, const KpcnHostTile&, std::span<const float>, std::span<const float>,
                   std::span<const uint32_t>, std::span<float>, size_t) {}

#else

namespace {

/// Rows of the output layer that are computed at a time. With 441 channels, they take about 2 MB for every 64
/// pixels of width.
constexpr uint32_t bandRows = 16;
/// The logit of taps that are excluded: their weight is e^leastExponent.
constexpr float noLogit = -1e30f;

/// The unpacked normals of a part of the picture (features.faces() in training/limpid_training/features.py).
class Faces {
  public:
    /// `minCosine`: KpcnWeights::facing.
    Faces(std::span<const uint32_t> packed, float minCosine) : minCosine_(minCosine) {
        for (size_t c = 0; c < components_.size(); ++c) {
            components_[c].resize(packed.size());
            for (size_t i = 0; i < packed.size(); ++i)
                components_[c][i] =
                    static_cast<float>(static_cast<int8_t>(packed[i] >> (8 * c) & 255u)) / 127.0f;
        }
    }
    /// For each x in [begin, end): excludes the tap, by setting logits[x] to noLogit, if the normals of the
    /// pixels `a` + x and `b` + x differ too much. A pixel never excludes itself (kpcn_softmax.glsl).
    void mask(size_t a, size_t b, size_t begin, size_t end, float* logits) const {
        if (a == b) return;
        const float *p = components_[0].data(), *q = components_[1].data(), *r = components_[2].data(),
                    *s = components_[3].data();
        for (size_t x = begin; x < end; ++x) {
            const float cosine =
                p[a + x] * p[b + x] + q[a + x] * q[b + x] + r[a + x] * r[b + x] + s[a + x] * s[b + x];
            logits[x] = cosine >= minCosine_ ? logits[x] : noLogit;
        }
    }

  private:
    std::array<std::vector<float>, 4> components_;
    float minCosine_;
};

/// Computes the weighted means of one row of pixels. Loops run over taps outside and over the row's pixels
/// inside, so that compilers can vectorise them.
class RowOfMeans {
  public:
    RowOfMeans(const KpcnHostTile& tile, uint32_t kernelWidth, std::span<const float> light,
               const Faces& faces)
        : tile_(tile),
          kernelWidth_(kernelWidth),
          light_(light),
          faces_(faces),
          sums_(6 * size_t{tile.columns}) {}

    /// `logits`: (channels, count, columns). Uses their row `row`, which is row `y` of the part, and
    /// overwrites it.
    void compute(std::span<float> logits, uint32_t count, uint32_t row, uint32_t y, float* clean) {
        const size_t n = tile_.columns;
        std::fill(sums_.begin(), sums_.end(), 0.0f);
        float *largest = &sums_[0], *weights = &sums_[n], *red = &sums_[2 * n], *green = &sums_[3 * n],
              *blue = &sums_[4 * n], *squares = &sums_[5 * n];
        std::fill_n(largest, n, noLogit);
        eachTap(logits, count, row, y, [&](float* logit, size_t from, size_t begin, size_t end) {
            faces_.mask(y * n, from, begin, end, logit);
            for (size_t x = begin; x < end; ++x) largest[x] = std::max(largest[x], logit[x]);
        });
        eachTap(logits, count, row, y, [&](float* logit, size_t from, size_t begin, size_t end) {
            const float* light = &light_[4 * (from + begin)];
            for (size_t x = begin; x < end; ++x)
                logit[x] = std::max(logit[x] - largest[x], neural::leastExponent);
            for (size_t x = begin; x < end; ++x, light += 4) {
                const float weight = neural::exponential(logit[x]);
                weights[x] += weight;
                red[x] += weight * light[0];
                green[x] += weight * light[1];
                blue[x] += weight * light[2];
                squares[x] += weight * weight * light[3];
            }
        });
        for (size_t x = tile_.left; x < tile_.left + tile_.width; ++x, clean += 4) {
            clean[0] = red[x] / weights[x];
            clean[1] = green[x] / weights[x];
            clean[2] = blue[x] / weights[x];
            clean[3] = std::sqrt(squares[x]) / weights[x];
        }
    }

  private:
    /// Calls visit(logits, from, begin, end) for each tap of the kernel: the tap of pixel x of the row is
    /// pixel `from` + x of the part, for x in [begin, end). Skips taps outside the part; for the pixels that
    /// are to be computed, these also lie outside the picture.
    template <typename Visit>
    void eachTap(std::span<float> logits, uint32_t count, uint32_t row, uint32_t y, Visit visit) const {
        const int n = static_cast<int>(tile_.columns), reach = static_cast<int>(kernelWidth_ / 2);
        for (uint32_t k = 0; k < kernelWidth_ * kernelWidth_; ++k) {
            const int dx = static_cast<int>(k % kernelWidth_) - reach,
                      dy = static_cast<int>(k / kernelWidth_) - reach;
            const int tapRow = static_cast<int>(y) + dy;
            if (tapRow < 0 || tapRow >= static_cast<int>(tile_.rows)) continue;
            const int begin = std::max(0, -dx), end = std::min(n, n - dx);
            if (begin < end)
                visit(&logits[(size_t{k} * count + row) * tile_.columns],
                      static_cast<size_t>(tapRow) * tile_.columns + static_cast<size_t>(dx),
                      static_cast<size_t>(begin), static_cast<size_t>(end));
        }
    }

    const KpcnHostTile& tile_;
    uint32_t kernelWidth_;
    std::span<const float> light_;
    const Faces& faces_;
    std::vector<float> sums_;  ///< one row each: largest logit, weights, red, green, blue, weighted variances
};

}  // namespace

struct KpcnHost::Impl {
    uint32_t kernelWidth = 0;
    float facing = 0.0f;
    std::array<std::unique_ptr<neural::ConvolutionChain>, 2> sides;
};

bool kpcnHostAvailable() {
    return true;
}

KpcnHost::KpcnHost(const KpcnWeights& weights) : impl_(std::make_unique<Impl>()) {
    impl_->kernelWidth = weights.kernelWidth;
    impl_->facing = weights.facing;
    for (size_t side = 0; side < 2; ++side) {
        std::vector<neural::ConvolutionLayer> layers;
        for (const KpcnLayer& layer : weights.sides[side]) {
            const bool hidden = &layer != &weights.sides[side].back();
            layers.push_back({layer.inputs, layer.outputs, layer.weights, layer.bias, hidden});
        }
        impl_->sides[side] = std::make_unique<neural::ConvolutionChain>(layers);
    }
}

KpcnHost::~KpcnHost() = default;

void KpcnHost::run(size_t side, const KpcnHostTile& tile, std::span<const float> channels,
                   std::span<const float> light, std::span<const uint32_t> packedFaces,
                   std::span<float> clean, size_t pitch) {
    const Faces faces(packedFaces.first(size_t{tile.columns} * tile.rows), impl_->facing);
    neural::ConvolutionChain& chain = *impl_->sides[side];
    chain.begin(channels, tile.columns, tile.rows);
    for (uint32_t first = tile.top; first < tile.top + tile.height; first += bandRows) {
        const uint32_t count = std::min(bandRows, tile.top + tile.height - first);
        const std::span<float> logits = chain.rows(first, count);
        tbb::parallel_for(0u, count, [&](uint32_t row) {
            RowOfMeans(tile, impl_->kernelWidth, light, faces)
                .compute(logits, count, row, first + row, &clean[4 * pitch * (first + row - tile.top)]);
        });
    }
}

#endif

}  // namespace limpid::denoise
