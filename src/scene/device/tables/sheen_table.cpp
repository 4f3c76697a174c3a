// Computes the albedo of the sheen's lobe (shaders/material/sheen.glsl) by quadrature.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/device/pack.h"

namespace limpid::scene {
namespace {

constexpr uint32_t size = layout::SHEEN_TABLE_SIZE;
constexpr int cosines = 96, angles = 64;

/// The fit of A. Conty Estevez and C. Kulla, as in shaders/material/sheen.glsl.
double lambda(double cosine, double alpha) {
    const double t = (1.0 - alpha) * (1.0 - alpha);
    const auto between = [t](double rough, double smooth) { return rough + (smooth - rough) * t; };
    const double a = between(21.5473, 25.3245), b = between(3.82987, 3.32435), c = between(0.19823, 0.16801);
    const double d = between(-1.97760, -1.27393), e = between(-4.32054, -4.85967);
    const auto l = [&](double x) { return a / (1.0 + b * std::pow(x, c)) + d * x + e; };
    return std::exp(cosine < 0.5 ? l(cosine) : 2.0 * l(0.5) - l(1.0 - cosine));
}

/// Returns the integral of D / (4 cos(wo) (1 + L(wo) + L(wi))) over the hemisphere of wi.
double albedo(double cosine, double alpha) {
    const double sine = std::sqrt(1.0 - cosine * cosine), out = lambda(cosine, alpha);
    double sum = 0.0;
    for (int i = 0; i < cosines; ++i) {
        // The lobe of smooth fibres is at grazing angles: points are dense there.
        const double t = (i + 0.5) / cosines, inCosine = t * t, inSine = std::sqrt(1.0 - inCosine * inCosine);
        double ring = 0.0;
        for (int k = 0; k < angles; ++k) {
            const double phi = static_cast<double>(pi) * (k + 0.5) / angles;
            const double x = sine + inSine * std::cos(phi), y = inSine * std::sin(phi), z = cosine + inCosine;
            const double sine2 = (x * x + y * y) / (x * x + y * y + z * z);
            ring += std::pow(sine2, 0.5 / alpha);
        }
        sum += 2.0 * t * ring / (1.0 + out + lambda(inCosine, alpha));
    }
    // The mean over the cosine and half a turn, times 2 pi, times D's factor (2 + 1 / alpha) / (2 pi).
    return sum / (cosines * angles) * (2.0 + 1.0 / alpha) / (4.0 * cosine);
}

}  // namespace

void fillSheenTable(std::vector<vec4>& table) {
    const size_t first = table.size();
    table.resize(first + size_t{size} * size);
    tbb::parallel_for(0u, size, [&](uint32_t row) {
        const double roughness =
            std::max(static_cast<double>(row) / (size - 1), double{layout::MIN_SHEEN_ROUGHNESS});
        for (uint32_t i = 0; i < size; ++i) {
            const double root = std::max(static_cast<double>(i) / (size - 1), 0.02);
            const double value = albedo(std::min(root * root, 1.0), roughness * roughness);
            table[first + size_t{row} * size + i] = vec4(static_cast<float>(value), 0.0f, 0.0f, 0.0f);
        }
    });
}

}  // namespace limpid::scene
