// From downloaded means to the layers of an EXR file (docs/layers.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/layers/layer_set.h"
#include "gpu/graph/frame_graph.h"
#include "image/image.h"

namespace limpid {

/// Depth of a pixel that sees nothing, in files.
inline constexpr float missDepth = noValue;

/// Running means as they come from the device, four floats a pixel (base/layers/layer_table.h says which);
/// `ids` are instance and material, two a pixel. Layers that were not computed are empty.
struct RenderedLayers : LayerSet<std::vector<float>, std::vector<uint32_t>> {
    gpu::Extent extent;
    uint64_t samples = 0;
    /// Alpha of a path-traced beauty: the share of the samples that met a surface. `depth` says it of others.
    std::vector<float> beauty;

    /// Of one of frameLayers that is a mean, or of beautyLayer.
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

/// Splits "diffuse,normal" or "all". Throws UsageError listing the names on one that does not exist.
std::vector<std::string> parseLayers(std::string_view list);

/// The beauty, three components: diffuse + specular + emission, exact in float32 if layers were computed.
image::Image beautyOf(const RenderedLayers& layers);

/// Of each pixel, the share of the samples that met a surface, one component; empty where nothing says it.
std::vector<float> surfaceShare(const RenderedLayers& layers);

/// Channels for an EXR file: beauty as R G B A plus those of the layers named that were computed.
/// `colorStorage` is that of Stored::Color.
image::LayeredImage toLayeredImage(const RenderedLayers& layers, const std::vector<std::string>& names,
                                   image::Storage colorStorage);

/// The channel of a file that holds the layer's variance, if there is one.
std::string varianceChannel(const LayerInfo& layer);

}  // namespace limpid
