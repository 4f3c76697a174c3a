// The geometry of an a-trous filter's levels, for methods that dispatch stages/atrous/level.glsl.
#pragma once

#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// Distance in pixels between the taps of level `number`, counted from 1.
constexpr int levelStep(int number) {
    return 1 << (number - 1);
}

/// The number of invocations of a level. Each filters a `block` of pixels that lie a step apart (BLOCK in the
/// shader).
constexpr gpu::Extent levelInvocations(gpu::Extent picture, int step, gpu::Extent block) {
    const auto along = [&](uint32_t pixels, uint32_t blockPixels) {
        const uint32_t span = blockPixels * static_cast<uint32_t>(step);
        return (pixels + span - 1) / span * static_cast<uint32_t>(step);
    };
    return {along(picture.width, block.width), along(picture.height, block.height)};
}

}  // namespace limpid::denoise
