// Scales a picture down by an integer factor while its rows arrive: each cell becomes its mean.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/io/rows/memory_bound.h"

namespace limpid::image {

class RowReducer {
  public:
    RowReducer(PictureSize from, uint32_t components, uint32_t reduction)
        : from_(from), to_(reduced(from, reduction)), components_(components), reduction_(reduction) {
        sums_.resize(size_t{to_.width} * components);
        means_.resize(sums_.size());
    }

    PictureSize size() const { return to_; }
    /// Returns the row of the result that contains row `y`.
    uint32_t rowOf(uint32_t y) const { return std::min(y / reduction_, to_.height - 1); }

    /// Adds row `y`; rows come from top to bottom or from bottom to top. After the last row of a cell,
    /// returns the means of row rowOf(y), valid until the next call; otherwise nothing.
    std::span<const float> add(uint32_t y, std::span<const float> row);

  private:
    PictureSize from_, to_;
    uint32_t components_, reduction_;
    std::vector<double> sums_;
    std::vector<float> means_;
    uint32_t rows_ = 0;
};

}  // namespace limpid::image
