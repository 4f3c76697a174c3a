#include "image/metrics/separable_filter.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace limpid::image {
namespace {

void addScaled(std::vector<double>& sums, const float* values, double weight) {
    double* sum = sums.data();
    const size_t count = sums.size();
    for (size_t x = 0; x < count; ++x) sum[x] += weight * static_cast<double>(values[x]);
}

void store(const std::vector<double>& sums, float* target) {
    for (size_t x = 0; x < sums.size(); ++x) target[x] = static_cast<float>(sums[x]);
}

Image filterRows(const Image& in, const Kernel& kernel) {
    Image out(in.width, in.height, 1);
    const size_t width = in.width;
    const size_t radius = kernel.size() / 2;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, in.height), [&](const auto& rows) {
        std::vector<float> padded(width + 2 * radius);
        std::vector<double> sums(width);
        for (size_t y = rows.begin(); y != rows.end(); ++y) {
            const float* row = &in.pixels[y * width];
            std::fill_n(padded.begin(), radius, row[0]);
            std::copy_n(row, width, padded.data() + radius);
            std::fill_n(padded.data() + radius + width, radius, row[width - 1]);
            std::fill(sums.begin(), sums.end(), 0.0);
            for (size_t k = 0; k < kernel.size(); ++k) addScaled(sums, &padded[k], kernel[k]);
            store(sums, &out.pixels[y * width]);
        }
    });
    return out;
}

Image filterColumns(const Image& in, const Kernel& kernel) {
    Image out(in.width, in.height, 1);
    const size_t width = in.width;
    const auto radius = static_cast<int64_t>(kernel.size() / 2);
    const int64_t lastRow = int64_t{in.height} - 1;
    tbb::parallel_for(tbb::blocked_range<int64_t>(0, lastRow + 1), [&](const auto& rows) {
        std::vector<double> sums(width);
        for (int64_t y = rows.begin(); y != rows.end(); ++y) {
            std::fill(sums.begin(), sums.end(), 0.0);
            for (size_t k = 0; k < kernel.size(); ++k) {
                const int64_t from = std::clamp<int64_t>(y + static_cast<int64_t>(k) - radius, 0, lastRow);
                addScaled(sums, &in.pixels[static_cast<size_t>(from) * width], kernel[k]);
            }
            store(sums, &out.pixels[static_cast<size_t>(y) * width]);
        }
    });
    return out;
}

}  // namespace

Kernel gaussianKernel(int radius, double sigma) {
    Kernel kernel;
    double sum = 0.0;
    for (int x = -radius; x <= radius; ++x) {
        kernel.push_back(std::exp(-x * x / (2.0 * sigma * sigma)));
        sum += kernel.back();
    }
    for (double& weight : kernel) weight /= sum;
    return kernel;
}

Image filterSeparably(const Image& in, const Kernel& horizontal, const Kernel& vertical) {
    return filterColumns(filterRows(in, horizontal), vertical);
}

}  // namespace limpid::image
