// The ingest pass: converts another renderer's images from its encodings to those that the denoisers read.
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

/// Passes: "ingest"; "ingest/reflection" if there are hit distances but no motion of reflections;
/// "ingest/ids" if there are ids. `params.present` is ignored; it is derived from the images. Radiance,
/// normal and depth are required.
DenoiserInput ingest(gpu::FrameGraph& graph, const IngestImages& images, IngestParams params);

}  // namespace limpid::denoise
