// The ingest pass: another renderer's images, in the encodings it has, become what the denoisers read.
#pragma once

#include <array>

#include "denoise/api/denoiser_input.h"
#include "denoise/stages/ingest/ingest_params.h"

namespace limpid::denoise {

/// Images of a frame, by limpid_input (limpid/denoise.h). Empty handles: the caller does not have them.
struct IngestImages {
    gpu::ImageHandle radiance, specular, emission, albedo, albedoSpecular;
    gpu::ImageHandle normal, depth, motion, previousNormal, reflectionMotion;
    gpu::ImageHandle id;  ///< unsigned integers
};

/// Passes: "ingest", and "ingest/ids" if there are any. `params` but for `present`, which follows from the
/// images. Radiance, normal and depth must be there.
DenoiserInput ingest(gpu::FrameGraph& graph, const IngestImages& images, IngestParams params);

}  // namespace limpid::denoise
