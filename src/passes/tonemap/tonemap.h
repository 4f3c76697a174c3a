// The tone-mapping pass: converts linear radiance to display values.
#pragma once

#include "gpu/graph/frame_graph.h"
#include "image/tone_curve.h"

namespace limpid {

/// Returns RGBA8, encoded sRGB, alpha 1: image::tonemap() of the radiance (rgba32f), or of the sum of both
/// images if `added` is given, to within one step. `stops`: exposure. The pass is called "tonemap".
gpu::ImageHandle tonemap(gpu::FrameGraph& graph, gpu::ImageHandle radiance, float stops,
                         gpu::ImageHandle added = {}, image::ToneCurve curve = image::ToneCurve::Standard);

}  // namespace limpid
