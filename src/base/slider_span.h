// The range of a slider: the useful part of a parameter's range, on a suitable scale.
#pragma once

namespace limpid {

enum class SliderScale { Linear, Logarithmic };

struct SliderSpan {
    double min = 0.0, max = 1.0;  ///< within the parameter's range; values beyond must be typed
    SliderScale scale = SliderScale::Linear;
    double smallest = 0.0;  ///< for a logarithmic slider that starts at 0: the smallest value above 0
};

/// Returns a default range for a parameter: the whole range if it is small enough, otherwise two decades
/// around the default. `whole`: the parameter is an integer.
SliderSpan usefulSpan(double minimum, double maximum, double initial, bool whole);

/// Returns the slider's position, 0 to 1, for a value. Values outside the span are clamped.
double sliderPosition(const SliderSpan& span, double value);
/// The inverse, rounded to three digits. The left end of a logarithmic slider that starts at 0 is 0.
double sliderValue(const SliderSpan& span, double position);

}  // namespace limpid
