// The compose stage, the last step of every method: filtered light times its albedo, plus emission.
#pragma once

#include <string>

#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// Light images are halves as in filter_image.glsl (Format::RGBA16Float), or RGBA32Float images.
struct ComposeInput {
    gpu::ImageHandle light, albedo;
    gpu::ImageHandle second,
        secondAlbedo;           ///< `second` empty: `light` was reflected by the sum of both albedos
    gpu::ImageHandle emission;  ///< empty: none is added
    gpu::ImageHandle target;    ///< RGBA16Float (rounded to nearest, clamped to its range) or RGBA32Float;
                                ///< empty: an RGBA32Float image of its own
    float minAlbedo = 0.0f;     ///< 0: light contains its albedo; the albedo images are not read
};

/// Returns radiance, alpha 1: the target. Pass `pass`.
gpu::ImageHandle compose(gpu::FrameGraph& graph, const std::string& pass, const ComposeInput& input);

}  // namespace limpid::denoise
