// The ingest passes: convert another renderer's images from their encodings to those that the denoisers read.
#pragma once

#include <array>

#include "denoise/api/denoiser_input.h"
#include "denoise/stages/ingest/ingest_params.h"

namespace limpid::denoise {

/// Images of a frame, indexed by limpid_input (limpid/denoise.h). A handle is empty if the caller does not
/// have that image.
struct IngestImages {
    gpu::ImageHandle radiance, specular, emission, albedo, albedoSpecular;
    gpu::ImageHandle normal, depth, motion, previousNormal, reflectionMotion;
    gpu::ImageHandle roughness, hitDistance;  ///< both or none
    gpu::ImageHandle id;                      ///< unsigned integers
};

/// What filters read of the frame. Light, albedo and ids are the caller's images themselves; normals,
/// distances and motion are converted, in halves and (distances) floats. Passes: "ingest";
/// "ingest/reflection" if there are two signals and the motion of reflections or hit distances;
/// "ingest/white" if an albedo is missing. Radiance, normal and depth are required. `params.hasMotion` is
/// ignored; it is derived from the images.
DenoiserInput ingest(gpu::FrameGraph& graph, const IngestImages& images, IngestParams params,
                     bool twoSignals);

}  // namespace limpid::denoise
