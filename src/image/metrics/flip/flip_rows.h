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

/// A symmetric filter, sum of weights[k] * (in[x + s] + in[x - s] - 2 in[x]) for s = (k + 1) * step, which
/// starts from `middle` * in[x]: 1 for a filter whose weights add up to 1, 0 for one whose weights add up to
/// 0. On a constant it gives exactly the constant, or 0.
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

/// Filters of the same values, computed together so that each value is loaded once.
struct FlipFilters {
    static constexpr size_t maxEvens = 3;
    size_t reach;  ///< number of weights of each; shorter filters have zeros behind theirs
    size_t evens;  ///< at least 1
    FlipEven even[maxEvens];
    FlipOdd odd;  ///< none if its weights are null
};

struct FlipRows {
    /// filmicCurve() of radiance * scale. Values that are not finite may give anything.
    void (*toneMap)(const float* radiance, double scale, size_t count, float* mapped);
    /// Linear RGB, interleaved, to the linearised CIELAB in which filtering is fair. `count` is any number.
    void (*toYcxcz)(const float* rgb, size_t count, float* y, float* cx, float* cz);
    /// The filters' results at in[0] .. in[count - 1], rounded up to whole groups; `step` is the distance of
    /// neighbours. They look up to `reach` steps past both ends.
    void (*filter)(const float* in, ptrdiff_t step, const FlipFilters& filters, size_t count);
    /// FLIP of each pixel; `largest` is what `distances` gives for the two colours that differ most.
    void (*errors)(const FlipRow& test, const FlipRow& reference, float largest, size_t count, float* error);
    /// HyAB distances, raised to qc, of what the eye makes of filtered colours.
    void (*distances)(const FlipRow& test, const FlipRow& reference, size_t count, float* distance);
};

/// FlipRows::filter for any processor, and for AVX2 with fused multiply-add.
void flipFilter(const float* in, ptrdiff_t step, const FlipFilters& filters, size_t count);
void flipFilterAvx2(const float* in, ptrdiff_t step, const FlipFilters& filters, size_t count);

/// The fastest that this processor runs.
const FlipRows& flipRows();

}  // namespace limpid::image
