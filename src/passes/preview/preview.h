// The preview pass: shades the first hits of the G-buffer like a modelling program, without the scene's
// lights.
#pragma once

#include "passes/gbuffer/gbuffer.h"

namespace limpid {

/// Returns rgba32f, from 0 to 1, in linear Rec. 709: the sum of the albedos, lit by a light at the camera and
/// a sky above; emitters in their own colour; a plain backdrop where the ray misses.
gpu::ImageHandle preview(gpu::FrameGraph& graph, const GBufferImages& gbuffer, const CameraParams& camera);

}  // namespace limpid
