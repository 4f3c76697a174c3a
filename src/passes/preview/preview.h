// The preview pass: shades the first hits of the G-buffer as a modelling program does, without the scene's
// lights.
#pragma once

#include "passes/gbuffer/gbuffer.h"

namespace limpid {

/// rgba32f, from 0 to 1, in linear Rec. 709: the sum of the albedos under a light at the camera and a sky
/// above; emitters in their colour; a plain backdrop where nothing was hit.
gpu::ImageHandle preview(gpu::FrameGraph& graph, const GBufferImages& gbuffer, const CameraParams& camera);

}  // namespace limpid
