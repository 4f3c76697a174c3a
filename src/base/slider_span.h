// What a slider runs over: the part of a parameter's range that is useful, on the scale that suits it.
#pragma once

namespace limpid {

enum class SliderScale { Linear, Logarithmic };

struct SliderSpan {
    double min = 0.0, max = 1.0;  ///< inside the range; other values of the range are typed
    SliderScale scale = SliderScale::Linear;
    double smallest = 0.0;  ///< of a logarithmic one from 0 on: the least value above 0
};

/// For a parameter about which nothing more is known: the whole range where that is handy, otherwise two
/// decades around the default. `whole`: of whole numbers.
SliderSpan usefulSpan(double minimum, double maximum, double initial, bool whole);

/// Where the slider stands, 0 to 1. Values outside the span stand at its ends.
double sliderPosition(const SliderSpan& span, double value);
/// The reverse, rounded to three digits. The left end of a logarithmic slider from 0 on is 0.
double sliderValue(const SliderSpan& span, double position);

}  // namespace limpid
