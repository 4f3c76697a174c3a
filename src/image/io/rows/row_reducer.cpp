#include "image/io/rows/row_reducer.h"

namespace limpid::image {

std::span<const float> RowReducer::add(uint32_t y, std::span<const float> row) {
    const auto end = [&](uint32_t cell, uint32_t cells, uint32_t size) {
        return cell + 1 == cells ? size : (cell + 1) * reduction_;
    };
    const float* pixel = row.data();
    for (uint32_t cell = 0, x = 0; cell < to_.width; ++cell) {
        double* sum = &sums_[size_t{cell} * components_];
        for (const uint32_t last = end(cell, to_.width, from_.width); x < last; ++x, pixel += components_) {
            for (uint32_t c = 0; c < components_; ++c) sum[c] += static_cast<double>(pixel[c]);
        }
    }
    ++rows_;
    const uint32_t cellRow = rowOf(y);
    if (rows_ < end(cellRow, to_.height, from_.height) - cellRow * reduction_) return {};
    for (uint32_t cell = 0; cell < to_.width; ++cell) {
        const uint32_t columns = end(cell, to_.width, from_.width) - cell * reduction_;
        const double share = 1.0 / (static_cast<double>(columns) * rows_);
        for (size_t i = size_t{cell} * components_; i < (size_t{cell} + 1) * components_; ++i) {
            means_[i] = static_cast<float>(sums_[i] * share);
            sums_[i] = 0.0;
        }
    }
    rows_ = 0;
    return means_;
}

}  // namespace limpid::image
