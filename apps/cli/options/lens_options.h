// --f-stop, --lens-diameter, --focus-distance, --focal-length and --sensor-height: the camera's lens.
#pragma once

#include <CLI/CLI.hpp>

#include "renderer/method/pipeline.h"
#include "scene/model/camera.h"

namespace limpid::cli {

void addLensOptions(CLI::App& command, scene::Lens& lens);

/// Throws UsageError if the options contradict each other, or the pipeline has no depth of field.
void checkLens(const scene::Lens& lens, const Pipeline& pipeline);

/// Throws UsageError if `camera`, which has the lens already, is orthographic, or does not know what is in
/// focus, or if the pipeline has no depth of field.
void checkLensOf(const scene::Camera& camera, const scene::Lens& lens, const Pipeline& pipeline);

}  // namespace limpid::cli
