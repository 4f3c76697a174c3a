// --animation, --frames, --fps, --time, --camera-path and --shutter: what `limpid render` shows over time.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "base/files/frame_pattern.h"
#include "renderer/sequence/sequence.h"

namespace limpid::cli {

struct SequenceChoice {
    std::string
        animation;  ///< a clip's name or number, or "all"; "none": at rest; "": the first, if time matters
    std::string cameraPath;  ///< a file or a built-in path
    int frames = 0;          ///< 0: one, or as many as the animation and the path last
    SequenceTiming timing;
    bool timeGiven = false;
};

void addSequenceOptions(CLI::App& command, SequenceChoice& choice);

/// Chooses the scene's clip; to be called before the scene is packed.
void chooseAnimation(const SequenceChoice& choice, const FramePattern& output, scene::Scene& scene);

/// The camera's path, if one is chosen. A built-in one lasts as long as the frames, or 10 s.
std::optional<scene::CameraPath> chosenPath(const SequenceChoice& choice, const scene::Scene& scene,
                                            const scene::Camera& camera);

/// How many frames there are. Throws UsageError if they do not fit the output's name.
int frameCount(const SequenceChoice& choice, const FramePattern& output, const scene::Scene& scene,
               const std::optional<scene::CameraPath>& path);

}  // namespace limpid::cli
