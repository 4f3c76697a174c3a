// For tests: a second implementation of FLIP, directly from the paper's formulas, in double precision and
// with two-dimensional filters. It shares no code with the one under test. Slow, so only for small images.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "image/image.h"

namespace limpid::image::direct {

constexpr double pi = std::numbers::pi;
using Vec = std::array<double, 3>;
using Matrix = std::array<Vec, 3>;

/// Linear display colours.
struct Picture {
    int width, height;
    std::vector<Vec> linear;
};

/// One channel. The border is repeated beyond the image.
struct Plane {
    int width, height;
    std::vector<double> values;
    double at(int x, int y) const {
        x = std::clamp(x, 0, width - 1);
        y = std::clamp(y, 0, height - 1);
        return values[static_cast<size_t>(y * width + x)];
    }
};

using Filter = std::function<double(int, int)>;

/// Convolves, with positive weights scaled to a sum of 1 and negative ones to -1.
inline Plane filtered(const Plane& in, int radius, const Filter& filter) {
    double positive = 0, negative = 0;
    for (int j = -radius; j <= radius; ++j) {
        for (int i = -radius; i <= radius; ++i) (filter(i, j) > 0 ? positive : negative) += filter(i, j);
    }
    Plane out = in;
    for (int y = 0; y < in.height; ++y) {
        for (int x = 0; x < in.width; ++x) {
            double sum = 0;
            for (int j = -radius; j <= radius; ++j) {
                for (int i = -radius; i <= radius; ++i) {
                    const double w = filter(i, j);
                    sum += w / (w > 0 ? positive : w < 0 ? -negative : 1.0) * in.at(x + i, y + j);
                }
            }
            out.values[static_cast<size_t>(y * in.width + x)] = sum;
        }
    }
    return out;
}

inline const Matrix toXyz = {{{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                              {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                              {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};

inline Vec times(const Matrix& m, const Vec& v) {
    Vec r{};
    for (size_t i = 0; i < 3; ++i) r[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return r;
}

/// Solves m x = v by Cramer's rule.
inline Vec solve(const Matrix& m, const Vec& v) {
    const auto det = [](const Matrix& a) {
        return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
               a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
               a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    };
    Vec r{};
    for (size_t k = 0; k < 3; ++k) {
        Matrix replaced = m;
        for (size_t i = 0; i < 3; ++i) replaced[i][k] = v[i];
        r[k] = det(replaced) / det(m);
    }
    return r;
}

inline Vec whiteRelative(const Vec& rgb) {
    const Vec white = times(toXyz, {1, 1, 1});
    Vec v = times(toXyz, rgb);
    for (size_t k = 0; k < 3; ++k) v[k] /= white[k];
    return v;
}

inline std::array<Plane, 3> toYcxcz(const Picture& picture) {
    std::array<Plane, 3> planes;
    planes.fill({picture.width, picture.height, {}});
    for (const Vec& rgb : picture.linear) {
        const Vec v = whiteRelative(rgb);
        planes[0].values.push_back(116 * v[1] - 16);
        planes[1].values.push_back(500 * (v[0] - v[1]));
        planes[2].values.push_back(200 * (v[1] - v[2]));
    }
    return planes;
}

inline Vec toHuntLab(const Vec& rgb) {
    const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : 841.0 / 108 * t + 4.0 / 29; };
    const Vec v = whiteRelative(rgb);
    const double l = 116 * f(v[1]) - 16;
    return {l, 0.01 * l * 500 * (f(v[0]) - f(v[1])), 0.01 * l * 200 * (f(v[1]) - f(v[2]))};
}

inline double hyab(const Vec& a, const Vec& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

inline std::vector<Vec> perceivedColors(const std::array<Plane, 3>& planes, double ppd) {
    const double sensitivities[3][4] = {
        {1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    std::array<Plane, 3> f;
    for (size_t k = 0; k < 3; ++k) {
        const double* s = sensitivities[k];
        f[k] = filtered(planes[k], radius, [&](int x, int y) {
            const double d2 = (x * x + y * y) / (ppd * ppd);
            return s[0] * std::sqrt(pi / s[1]) * std::exp(-pi * pi * d2 / s[1]) +
                   s[2] * std::sqrt(pi / s[3]) * std::exp(-pi * pi * d2 / s[3]);
        });
    }
    const Vec white = times(toXyz, {1, 1, 1});
    std::vector<Vec> colors;
    for (size_t i = 0; i < f[0].values.size(); ++i) {
        const double y = (f[0].values[i] + 16) / 116;
        Vec rgb =
            solve(toXyz, {(y + f[1].values[i] / 500) * white[0], y, (y - f[2].values[i] / 200) * white[2]});
        for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
        colors.push_back(toHuntLab(rgb));
    }
    return colors;
}

/// Returns the edge and point strengths of each pixel.
inline std::vector<std::array<double, 2>> features(Plane y, double ppd) {
    for (double& v : y.values) v = (v + 16) / 116;
    const double sd = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * sd));
    const auto gauss = [&](int i, int j) { return std::exp(-(i * i + j * j) / (2 * sd * sd)); };
    const Plane ex = filtered(y, radius, [&](int i, int j) { return -i * gauss(i, j); });
    const Plane ey = filtered(y, radius, [&](int i, int j) { return -j * gauss(i, j); });
    const Plane px = filtered(y, radius, [&](int i, int j) { return (i * i / (sd * sd) - 1) * gauss(i, j); });
    const Plane py = filtered(y, radius, [&](int i, int j) { return (j * j / (sd * sd) - 1) * gauss(i, j); });
    std::vector<std::array<double, 2>> result;
    for (size_t i = 0; i < y.values.size(); ++i) {
        result.push_back({std::hypot(ex.values[i], ey.values[i]), std::hypot(px.values[i], py.values[i])});
    }
    return result;
}

inline std::vector<double> flip(const Picture& test, const Picture& reference, double ppd) {
    const auto planesA = toYcxcz(test), planesB = toYcxcz(reference);
    const auto colorsA = perceivedColors(planesA, ppd), colorsB = perceivedColors(planesB, ppd);
    const auto featuresA = features(planesA[0], ppd), featuresB = features(planesB[0], ppd);
    const double cmax = std::pow(hyab(toHuntLab({0, 1, 0}), toHuntLab({0, 0, 1})), 0.7);
    std::vector<double> map;
    for (size_t i = 0; i < colorsA.size(); ++i) {
        const double d = std::pow(hyab(colorsA[i], colorsB[i]), 0.7);
        const double knee = 0.4 * cmax;
        const double color = d < knee ? 0.95 * d / knee : 0.95 + 0.05 * (d - knee) / (cmax - knee);
        const double edge = std::abs(featuresA[i][0] - featuresB[i][0]);
        const double point = std::abs(featuresA[i][1] - featuresB[i][1]);
        map.push_back(std::pow(color, 1 - std::sqrt(std::max(edge, point) / std::sqrt(2.0))));
    }
    return map;
}

inline double decode(double v) {
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

inline Picture decoded(const Image& encoded) {
    Picture picture{static_cast<int>(encoded.width), static_cast<int>(encoded.height), {}};
    for (size_t i = 0; i < encoded.pixels.size(); i += 3) {
        const float* p = &encoded.pixels[i];
        picture.linear.push_back({decode(p[0]), decode(p[1]), decode(p[2])});
    }
    return picture;
}

inline std::vector<double> flip(const Image& test, const Image& reference, double ppd) {
    return flip(decoded(test), decoded(reference), ppd);
}

}  // namespace limpid::image::direct
