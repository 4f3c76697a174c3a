// The loops of FLIP over rows of pixels, in single precision: compiled once for any processor and, on x86-64,
// once more for AVX2. They ask for values that are finite. Private to src/image.
#pragma once

#include <cstddef>

namespace limpid::image {

/// Rows are processed in whole groups of this many values, so that every pixel goes through the same vector
/// code: equal pixels have equal errors, wherever they are.
inline constexpr size_t flipGroup = 16;

constexpr size_t flipPadded(size_t count) {
    return (count + flipGroup - 1) / flipGroup * flipGroup;
}

/// One row of one picture as the eye filters it. Each has flipPadded(width) values.
struct FlipRow {
    float* y;  ///< YCxCz, filtered by contrast sensitivity
    float* cx;
    float* cz;
    float* edgeX;  ///< first derivatives of Y
    float* edgeY;
    float* pointX;  ///< second derivatives of Y
    float* pointY;
};

struct FlipRows {
    /// Linear RGB, interleaved, to the linearised CIELAB in which filtering is fair. `count` is any number.
    void (*toYcxcz)(const float* rgb, size_t count, float* y, float* cx, float* cz);
    /// sum[x] += weights[k] * (in[x + s] + in[x - s] - 2 in[x]) for s = (k + 1) * step: what a symmetric
    /// filter adds to the middle value, or to nothing if its weights' sum is 0. On a constant it is exactly
    /// 0.
    void (*addEven)(const float* in, ptrdiff_t step, const float* weights, size_t weightCount, size_t count,
                    float* sum);
    /// sum[x] += weights[k] * (in[x + s] - in[x - s]): an antisymmetric filter.
    void (*addOdd)(const float* in, ptrdiff_t step, const float* weights, size_t weightCount, size_t count,
                   float* sum);
    /// FLIP of each pixel; `largest` is what `distances` gives for the two colours that differ most.
    void (*errors)(const FlipRow& test, const FlipRow& reference, float largest, size_t count, float* error);
    /// HyAB distances, raised to qc, of what the eye makes of filtered colours.
    void (*distances)(const FlipRow& test, const FlipRow& reference, size_t count, float* distance);
};

/// The fastest that this processor runs.
const FlipRows& flipRows();

}  // namespace limpid::image
