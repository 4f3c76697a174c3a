#include "tests/reference/statistics.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace limpid::test {
namespace {

/// Regularised lower incomplete gamma function by its series, for x < a + 1.
double gammaSeries(double a, double x) {
    double term = 1.0 / a, sum = term;
    for (double n = a + 1.0; std::abs(term) > std::abs(sum) * 1e-15; n += 1.0) {
        term *= x / n;
        sum += term;
    }
    return sum * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

/// The upper incomplete gamma function by its continued fraction (Lentz).
double gammaFraction(double a, double x) {
    constexpr double tiny = std::numeric_limits<double>::min() / 1e-15;
    double b = x + 1.0 - a, c = 1.0 / tiny, d = 1.0 / b, h = d;
    for (int i = 1; i < 10000; ++i) {
        const double an = -i * (i - a);
        b += 2.0;
        d = an * d + b;
        if (std::abs(d) < tiny) d = tiny;
        c = b + an / c;
        if (std::abs(c) < tiny) c = tiny;
        d = 1.0 / d;
        h *= d * c;
        if (std::abs(d * c - 1.0) < 1e-15) break;
    }
    return h * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

}  // namespace

double chiSquareTail(double statistic, double degreesOfFreedom) {
    const double a = 0.5 * degreesOfFreedom, x = 0.5 * statistic;
    if (x <= 0.0 || a <= 0.0) return 1.0;
    return x < a + 1.0 ? 1.0 - gammaSeries(a, x) : gammaFraction(a, x);
}

double normalTail(double z) {
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

ChiSquare chiSquare(const std::vector<double>& observed, const std::vector<double>& expected, double least) {
    ChiSquare result;
    double worst = 0.0, o = 0.0, e = 0.0;
    int bins = 0;
    const auto add = [&](size_t end) {
        const double part = (o - e) * (o - e) / e;
        if (part > worst) {
            worst = part;
            result.worst = fmt::format("up to bin {}: {} observed, {:.1f} expected", end, o, e);
        }
        result.statistic += part;
        ++bins;
        o = e = 0.0;
    };
    for (size_t i = 0; i < expected.size(); ++i) {
        result.impossible |= observed[i] > 0.0 && expected[i] == 0.0;
        o += observed[i];
        e += expected[i];
        if (e >= least) add(i);
    }
    // The remainder is too small for its own bin, unless many observations fell there.
    if (e > 0.0 && o > 10.0 * least) add(expected.size());
    result.degreesOfFreedom = bins - 1;
    if (bins > 1) result.p = chiSquareTail(result.statistic, bins - 1);
    return result;
}

}  // namespace limpid::test
