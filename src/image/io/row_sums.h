// Parallel sums over pictures with the same result on every run. Private to src/image.
#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>
#include <numeric>
#include <vector>

namespace limpid::image {

/// Returns the sum of row(y) for y < height; rows are computed in parallel and added in order.
template <typename Row>
double sumRows(size_t height, const Row& row) {
    std::vector<double> sums(height);
    tbb::parallel_for(size_t{0}, height, [&](size_t y) { sums[y] = row(y); });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace limpid::image
