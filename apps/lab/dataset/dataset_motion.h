// Motion for a random room or still life: things and lights that move, and lights that are switched.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/sequence/sequence.h"
#include "scene/model/scene.h"

namespace limpid::cli {

/// How many of each.
struct ClipMotion {
    size_t objects = 0, lights = 0, switched = 0;
    size_t count() const { return objects + lights + switched; }
};

/// Adds nodes and a clip to the scene's rig, and chooses that clip; nothing where there is nothing to move.
/// It covers the times of all frames to the last of those that are stored, `frames`. Lights are switched
/// between two of these.
ClipMotion addMotion(scene::Scene& scene, uint32_t seed, const SequenceTiming& timing,
                     const std::vector<uint32_t>& frames);

/// Adds and chooses a clip in which something stands still, for the same pipelines as those of addMotion().
void addStillClip(scene::Scene& scene);

}  // namespace limpid::cli
