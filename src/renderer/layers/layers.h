// Converts downloaded means to the layers of an EXR file (docs/layers.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/layers/layer_set.h"
#include "gpu/graph/frame_graph.h"
#include "image/image.h"

namespace limpid {

/// Depth in files of a pixel that hits nothing.
inline constexpr float missDepth = noValue;

/// Running means as downloaded from the device, four floats per pixel (described in
/// base/layers/layer_table.h). `ids` are instance and material, two per pixel. Layers that were not computed
/// are empty.
struct RenderedLayers : LayerSet<std::vector<float>, std::vector<uint32_t>> {
    gpu::Extent extent;
    uint64_t samples = 0;
    /// Alpha of a path-traced beauty is the share of samples that hit a surface; for others `depth` gives it.
    std::vector<float> beauty;

    /// The values of one of frameLayers that is a mean, or of beautyLayer.
    std::vector<float>& operator[](const LayerInfo& layer) {
        return layer.index == beautyLayer.index ? beauty : LayerSet::operator[](layer);
    }
    const std::vector<float>& operator[](const LayerInfo& layer) const {
        return layer.index == beautyLayer.index ? beauty : LayerSet::operator[](layer);
    }
};

/// Names that --aov accepts, in the order of layerTable. "beauty" is always there; "variance" adds X.variance
/// to the layers that have one.
const std::vector<std::string>& layerNames();

/// Splits "diffuse,normal" or "all". Throws UsageError with the list of names if one is unknown.
std::vector<std::string> parseLayers(std::string_view list);

/// The beauty, three components: diffuse + specular + emission, exact in float32 if layers were computed.
image::Image beautyOf(const RenderedLayers& layers);

/// For each pixel, the share of the samples that hit a surface, one component; empty if it is unknown.
std::vector<float> surfaceShare(const RenderedLayers& layers);

/// Channels for an EXR file: beauty as R G B A, and the named layers that were computed. `colorStorage` is
/// used for Stored::Color.
image::LayeredImage toLayeredImage(const RenderedLayers& layers, const std::vector<std::string>& names,
                                   image::Storage colorStorage);

/// The channel of a file that holds the layer's variance, if there is one: "albedo.variance.V". Blender drops
/// channels whose name does not end in one letter.
std::string varianceChannel(const LayerInfo& layer);

}  // namespace limpid
