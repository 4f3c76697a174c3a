// The tone-mapping pass: converts linear radiance to display values.
#pragma once

#include "gpu/graph/frame_graph.h"
#include "image/tone_curve.h"

namespace limpid {

/// Returns RGBA8, encoded sRGB, alpha 1: image::tonemap() of the radiance (rgba32f), or of the sum of both
/// images if `added` is given, to within one step. `stops`: exposure. The pass is called "tonemap".
gpu::ImageHandle tonemap(gpu::FrameGraph& graph, gpu::ImageHandle radiance, float stops,
                         gpu::ImageHandle added = {}, image::ToneCurve curve = image::ToneCurve::Standard);

/// For displays of a high dynamic range. Returns RGBA16Float, alpha 1: image::extendedColor() of the radiance
/// times 2^stops, or of that of the sum of both images. The pass is called "tonemap", too.
gpu::ImageHandle tonemapExtended(gpu::FrameGraph& graph, gpu::ImageHandle radiance, float stops,
                                 gpu::ImageHandle added = {});

}  // namespace limpid
