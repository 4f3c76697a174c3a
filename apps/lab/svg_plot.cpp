#include "lab/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limpid::cli {
namespace {

constexpr double width = 640.0, left = 70.0, right = 30.0, top = 46.0;
constexpr std::array<const char*, 6> colors{"#2f6db3", "#c8553d", "#4a8f4f", "#8d5fb0", "#b98a1d", "#4b9aa8"};

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else
            result += c;
    }
    return result;
}

std::string head(const std::string& title, double height) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
        "font-family=\"sans-serif\" font-size=\"13\">\n"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n"
        "<text x=\"{2}\" y=\"24\" font-size=\"16\" text-anchor=\"middle\">{3}</text>\n",
        width, height, width / 2, escaped(title));
}

std::string text(double x, double y, const char* anchor, const std::string& what) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                       escaped(what));
}

/// Returns 1, 2 or 5 times a power of ten such that about five steps reach `largest`.
double niceStep(double largest) {
    const double rough = std::max(largest, 1e-12) / 5.0,
                 power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= rough) return factor * power;
    }
    return 10.0 * power;
}

/// Maps values to positions in the picture.
class Frame {
  public:
    Frame(const PlotAxes& axes, const std::vector<PlotLine>& lines) : axes_(axes) {
        minX_ = maxX_ = along(lines.front().points.front().x);
        for (const PlotLine& line : lines) {
            for (const PlotPoint& point : line.points) {
                minX_ = std::min(minX_, along(point.x));
                maxX_ = std::max(maxX_, along(point.x));
                maxY_ = std::max(maxY_, point.y);
            }
        }
        if (maxX_ == minX_) maxX_ = minX_ + 1.0;
        step_ = niceStep(maxY_);
        maxY_ = step_ * std::ceil(maxY_ / step_ + 1e-9);
    }

    static constexpr double height = 400.0, bottom = height - 60.0;

    double x(double value) const {
        return left + (along(value) - minX_) / (maxX_ - minX_) * (width - left - right);
    }
    double y(double value) const { return bottom - value / maxY_ * (bottom - top); }

    std::string drawn(const std::vector<PlotPoint>& points) const {
        std::string svg;
        for (double value = 0.0; value <= maxY_ * (1.0 + 1e-9); value += step_) {
            svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#ddd\"/>\n", left, y(value),
                               width - right);
            svg += text(left - 8, y(value) + 4, "end", fmt::format("{:.4g}", value));
        }
        for (const double mark : marks(points))
            svg += text(x(mark), bottom + 18, "middle", fmt::format("{:.0f}", mark));
        svg += text(left, top - 8, "start", axes_.y);
        return svg + text((left + width - right) / 2, bottom + 40, "middle", axes_.x);
    }

  private:
    /// Returns the points' x, or powers of ten on a logarithmic axis.
    std::vector<double> marks(const std::vector<PlotPoint>& points) const {
        std::vector<double> result;
        if (axes_.logarithmicX) {
            for (double power = std::ceil(minX_); power <= maxX_; power += 1.0)
                result.push_back(std::pow(10.0, power));
        } else {
            for (const PlotPoint& point : points) result.push_back(point.x);
        }
        return result;
    }

    double along(double value) const { return axes_.logarithmicX ? std::log10(value) : value; }

    const PlotAxes& axes_;
    double minX_ = 0.0, maxX_ = 0.0, maxY_ = 0.0, step_ = 1.0;
};

std::string lineOf(const Frame& frame, const PlotLine& line, const char* color) {
    std::string points, marks;
    for (const PlotPoint& point : line.points) {
        const double x = frame.x(point.x), y = frame.y(point.y);
        points += fmt::format("{:.1f},{:.1f} ", x, y);
        marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", x, y, color);
    }
    return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", points,
                       color) +
           marks;
}

}  // namespace

std::string barPlot(const std::string& title, const std::string& unit, const std::vector<Bar>& bars) {
    constexpr double row = 26.0, names = 190.0, values = 90.0;
    const double height = top + row * static_cast<double>(bars.size()) + 16.0;
    double largest = 1e-12;
    for (const Bar& bar : bars) largest = std::max(largest, bar.value);
    std::string svg = head(title, height);
    double y = top;
    for (const Bar& bar : bars) {
        const double length = bar.value / largest * (width - names - values);
        svg += text(names - 8, y + 15, "end", bar.name);
        svg += fmt::format("<rect x=\"{}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{}\" fill=\"{}\"/>\n",
                           names, y, length, row - 6, colors[0]);
        svg += text(names + length + 6, y + 15, "start", fmt::format("{:.4g} {}", bar.value, unit));
        y += row;
    }
    return svg + "</svg>\n";
}

std::string linePlot(const std::string& title, const PlotAxes& axes, const std::vector<PlotLine>& lines) {
    const Frame frame(axes, lines);
    std::string svg = head(title, Frame::height) + frame.drawn(lines.front().points);
    for (size_t i = 0; i < lines.size(); ++i) {
        const char* color = colors[i % colors.size()];
        svg += lineOf(frame, lines[i], color);
        const double y = top + 18.0 * static_cast<double>(i) + 6.0;
        svg += fmt::format("<rect x=\"{}\" y=\"{:.1f}\" width=\"12\" height=\"12\" fill=\"{}\"/>\n",
                           left + 14, y, color);
        svg += text(left + 32, y + 11, "start", lines[i].name);
    }
    return svg + "</svg>\n";
}

}  // namespace limpid::cli
