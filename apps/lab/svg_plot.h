// Plots as SVG: bars, and lines over a linear or logarithmic axis.
#pragma once

#include <string>
#include <vector>

namespace limpid::cli {

struct Bar {
    std::string name;
    double value = 0.0;  ///< 0 or more
};
/// Horizontal bars with their values. `unit` goes behind each value.
std::string barPlot(const std::string& title, const std::string& unit, const std::vector<Bar>& bars);

struct PlotPoint {
    double x = 0.0, y = 0.0;
};
struct PlotLine {
    std::string name;
    std::vector<PlotPoint> points;  ///< by growing x
};
struct PlotAxes {
    std::string x, y;           ///< what they show
    bool logarithmicX = false;  ///< all x above 0
};
/// The y axis starts at 0. At least one line with at least one point.
std::string linePlot(const std::string& title, const PlotAxes& axes, const std::vector<PlotLine>& lines);

}  // namespace limpid::cli
