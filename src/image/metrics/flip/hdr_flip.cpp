// HDR-FLIP. Section and formulas are those of the paper that image/metrics/metrics.h names.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "image/metrics/flip/flip.h"
#include "image/metrics/flip/flip_rows.h"
#include "image/metrics/metrics.h"
#include "image/metrics/metrics_check.h"
#include "image/tonemap.h"

namespace limpid::image {
namespace {

/// Where the brightest pixel lands at the first exposure and the median one at the last.
constexpr double displayTarget = 0.85;

/// Mean of the two middle values where their number is even. `values` is not empty and is reordered.
double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

std::vector<double> luminances(const Image& radiance) {
    std::vector<double> values(size_t{radiance.width} * radiance.height);
    for (size_t i = 0; i < values.size(); ++i) {
        const float* p = &radiance.pixels[3 * i];
        const auto positive = [](float v) { return std::max(static_cast<double>(v), 0.0); };
        values[i] = 0.2126 * positive(p[0]) + 0.7152 * positive(p[1]) + 0.0722 * positive(p[2]);
    }
    return values;
}

/// Sets `mapped` to linear display values in [0,1]; those of pixels that are not finite may be anything.
void toneMap(const Image& radiance, double stops, Image& mapped) {
    const double scale = std::exp2(stops);
    const size_t rowValues = size_t{radiance.width} * 3;
    tbb::parallel_for(size_t{0}, size_t{radiance.height}, [&](size_t y) {
        flipRows().toneMap(&radiance.pixels[y * rowValues], scale, rowValues, &mapped.pixels[y * rowValues]);
    });
}

}  // namespace

HdrFlipExposures hdrFlipExposures(const Image& reference) {
    checkComparable(reference, reference);
    checkReferenceValid(reference);
    std::vector<double> values = luminances(reference);
    const double brightest = *std::max_element(values.begin(), values.end());
    if (brightest == 0.0) return {};
    double typical = median(values);
    if (typical == 0.0) {
        std::erase(values, 0.0);
        typical = median(values);
    }
    const double target = filmicCurveInverse(displayTarget);
    HdrFlipExposures exposures;
    exposures.start = std::log2(target / brightest);
    exposures.stop = std::log2(target / typical);
    exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
    return exposures;
}

HdrFlip hdrFlip(const Image& test, const Image& reference, double pixelsPerDegree,
                const HdrFlipProgress& progress) {
    checkComparable(test, reference);
    const std::vector<size_t> bad = invalidPixels(test);
    HdrFlip result;
    result.exposures = hdrFlipExposures(reference);
    result.map = Image(test.width, test.height, 1, 0.0f);
    Image shownTest(test.width, test.height, 3), shownReference = shownTest;
    LinearFlip flip(test.width, test.height, pixelsPerDegree);
    const double step = (result.exposures.stop - result.exposures.start) / (result.exposures.count - 1);
    for (int k = 0; k < result.exposures.count; ++k) {
        if (progress) progress(k, result.exposures.count);
        const double stops = result.exposures.start + k * step;
        toneMap(reference, stops, shownReference);
        toneMap(test, stops, shownTest);
        showAsWorst(bad, shownReference, shownTest);
        flip.compare(shownTest, shownReference, result.map);
    }
    for (const size_t pixel : bad) result.map.pixels[pixel] = 1.0f;
    result.value = mean(result.map);
    return result;
}

}  // namespace limpid::image
