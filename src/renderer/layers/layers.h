// From downloaded means to the layers of an EXR file (docs/layers.md).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "image/image.h"

namespace limpid {

/// Depth of a pixel that sees nothing, in files.
inline constexpr float missDepth = 1e10f;

/// Running means as they come from the device, four floats a pixel (passes/pathtrace/pathtrace.h says which).
/// Layers that were not computed are empty.
struct RenderedLayers {
    gpu::Extent extent;
    uint64_t samples = 0;
    /// Alpha of a path-traced beauty: the share of the samples that met a surface. `depth` says it of others.
    std::vector<float> beauty, diffuse, specular, emission, albedo, albedoSpecular, normal, previousNormal,
        depth, motion, reflectionMotion;
    std::vector<uint32_t> ids;  ///< instance and material, two a pixel
};

/// Names that --aov accepts. "beauty" is always there; "variance" adds X.variance to diffuse, specular,
/// albedo, normal and depth.
const std::vector<std::string>& layerNames();

/// Splits "diffuse,normal" or "all". Throws UsageError listing the names on one that does not exist.
std::vector<std::string> parseLayers(std::string_view list);

/// The beauty, three components: diffuse + specular + emission, exact in float32 if layers were computed.
image::Image beautyOf(const RenderedLayers& layers);

/// Of each pixel, the share of the samples that met a surface, one component; empty where nothing says it.
std::vector<float> surfaceShare(const RenderedLayers& layers);

/// Channels for an EXR file: beauty as R G B A plus the layers named. Colours and normals are stored as
/// `colorStorage`, depth, motion, variances and counts as float.
image::LayeredImage toLayeredImage(const RenderedLayers& layers, const std::vector<std::string>& names,
                                   image::Storage colorStorage);

}  // namespace limpid
