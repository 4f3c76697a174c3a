// The loops of FLIP over rows of pixels, in single precision. They are compiled for the baseline instruction
// set and, on x86-64, again for AVX2. All values must be finite. Private to src/image.
#pragma once

#include <cstddef>

namespace limpid::image {

/// Rows are processed in whole groups of this many values. So every pixel goes through the same vector code,
/// and equal pixels have equal errors regardless of their position.
inline constexpr size_t flipGroup = 16;

constexpr size_t flipPadded(size_t count) {
    return (count + flipGroup - 1) / flipGroup * flipGroup;
}

/// One row of one picture after FLIP's spatial filters. Each array has flipPadded(width) values.
struct FlipRow {
    float* y;  ///< YCxCz, filtered by contrast sensitivity
    float* cx;
    float* cz;
    float* edgeX;  ///< first derivatives of Y
    float* edgeY;
    float* pointX;  ///< second derivatives of Y
    float* pointY;
};

/// A symmetric filter: middle * in[x] + sum of weights[k] * (in[x + s] + in[x - s] - 2 in[x]) with s = (k +
/// 1)
/// * step. `middle` is the sum of the filter's weights: 1 for smoothing, 0 for a second derivative. In this
/// form a constant input gives exactly the constant, or 0.
struct FlipEven {
    const float* weights;
    float middle;
    float* result;
};

/// An antisymmetric filter: the sum of weights[k] * (in[x + s] - in[x - s]).
struct FlipOdd {
    const float* weights;
    float* result;
};

/// Filters of the same input, computed together so that each value is loaded once.
struct FlipFilters {
    static constexpr size_t maxEvens = 3;
    size_t reach;  ///< number of weights of each filter; shorter ones are zero-padded
    size_t evens;  ///< at least 1
    FlipEven even[maxEvens];
    FlipOdd odd;  ///< none if its weights are null
};

struct FlipRows {
    /// Converts interleaved linear RGB to YCxCz, a linearised CIELAB space in which FLIP filters. `count`
    /// need not be a multiple of the group size.
    void (*toYcxcz)(const float* rgb, size_t count, float* y, float* cx, float* cz);
    /// Applies the filters at in[0] .. in[count - 1], rounded up to whole groups. `step` is the distance of
    /// neighbouring values. Reads up to `reach` steps beyond both ends.
    void (*filter)(const float* in, ptrdiff_t step, const FlipFilters& filters, size_t count);
    /// Computes the FLIP error of each pixel. `largest` is the result of `distances` for the two colours that
    /// differ most.
    void (*errors)(const FlipRow& test, const FlipRow& reference, float largest, size_t count, float* error);
    /// Computes the HyAB distances between filtered colours, raised to the power qc.
    void (*distances)(const FlipRow& test, const FlipRow& reference, size_t count, float* distance);
};

/// FlipRows::filter for the baseline instruction set, and for AVX2 with fused multiply-add.
void flipFilter(const float* in, ptrdiff_t step, const FlipFilters& filters, size_t count);
void flipFilterAvx2(const float* in, ptrdiff_t step, const FlipFilters& filters, size_t count);

/// Returns the fastest variant that this processor supports.
const FlipRows& flipRows();

}  // namespace limpid::image
