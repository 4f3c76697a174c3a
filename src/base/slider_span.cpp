#include "base/slider_span.h"

#include <algorithm>
#include <cmath>

namespace limpid {
namespace {

constexpr double decades = 100.0;   ///< factor up and down from the default
constexpr double zeroShare = 0.03;  ///< fraction of a logarithmic slider's length that stands for 0
constexpr double nearTheEnd = 0.02;

double roundedToDigits(double value) {
    if (value == 0.0) return 0.0;
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
    return std::round(value / unit) * unit;
}

/// Returns the start of the logarithmic part.
double firstOf(const SliderSpan& span) {
    return span.min > 0.0 ? span.min : span.smallest;
}

}  // namespace

SliderSpan usefulSpan(double minimum, double maximum, double initial, bool whole) {
    const double width = maximum - minimum;
    if (whole) {
        constexpr double handy = 128.0;
        return {minimum, width <= handy ? maximum : std::min(maximum, std::max(8.0, 8.0 * initial))};
    }
    const bool manyDecades = minimum > 0.0 && maximum > decades * minimum;
    const bool defaultAtTheEnd =
        width > decades || (initial - minimum < nearTheEnd * width && initial > minimum);
    if (minimum < 0.0 || !(manyDecades || defaultAtTheEnd)) return {minimum, maximum};
    const double middle = initial > 0.0 ? initial : 1.0;
    SliderSpan span{minimum, std::min(maximum, decades * middle), SliderScale::Logarithmic};
    if (minimum > 0.0)
        span.min = std::max(minimum, middle / decades);
    else
        span.smallest = middle / decades;
    return span;
}

double sliderPosition(const SliderSpan& span, double value) {
    const double inside = std::clamp(value, span.min, span.max);
    if (span.scale == SliderScale::Linear) return (inside - span.min) / (span.max - span.min);
    const double start = span.min > 0.0 ? 0.0 : zeroShare, first = firstOf(span);
    if (inside < first) return 0.0;
    return start + (1.0 - start) * std::log(inside / first) / std::log(span.max / first);
}

double sliderValue(const SliderSpan& span, double position) {
    if (position <= 0.0) return span.min;
    if (position >= 1.0) return span.max;
    double value = span.min + position * (span.max - span.min);
    if (span.scale == SliderScale::Logarithmic) {
        const double start = span.min > 0.0 ? 0.0 : zeroShare, first = firstOf(span);
        if (position < start) return span.min;
        value = first * std::pow(span.max / first, (position - start) / (1.0 - start));
    }
    return std::clamp(roundedToDigits(value), span.min, span.max);
}

}  // namespace limpid
