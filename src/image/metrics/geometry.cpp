#include "image/metrics/geometry.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace limpid::image {
namespace {

std::optional<Image> layerIfThere(const LayeredImage& layers, const std::string& name,
                                  std::string_view suffixes) {
    const bool complete = std::all_of(suffixes.begin(), suffixes.end(), [&](char suffix) {
        return layers.find(name + "." + suffix) != nullptr;
    });
    if (!complete) return std::nullopt;
    return layers.get(name, suffixes);
}

}  // namespace

bool validMotion(float x, float y) {
    // Comparisons with NaN are false.
    return std::abs(x) < 1e6f && std::abs(y) < 1e6f;
}

Geometry geometryOf(const LayeredImage& layers) {
    return {.motion = layerIfThere(layers, "motion", "XY"),
            .distanceChange = layerIfThere(layers, "motion", "Z"),
            .depth = layerIfThere(layers, "depth", "Z"),
            .normal = layerIfThere(layers, "normal", "XYZ")};
}

}  // namespace limpid::image
