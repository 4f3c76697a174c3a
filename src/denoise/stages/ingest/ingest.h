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
    gpu::ImageHandle roughness, hitDistance;              ///< both or none
    gpu::ImageHandle id;                                  ///< unsigned integers
    gpu::ImageHandle radianceVariance, specularVariance;  ///< both or none; with specular, if that is given
};

/// What the method that follows reads.
struct IngestNeeds {
    bool twoSignals = false;
    bool layers = false;  ///< normal, depth and motion, besides the surfaces
    bool albedo = true;
    uint32_t samples = 1;  ///< per pixel, if the method reads the light's variance
    gpu::Backing filters = gpu::Backing::Image;
};

/// What filters read of the frame. Light, albedo, ids, motion and previous normals are the caller's
/// images themselves, unless its variance is given and read; normals and distances are converted. Passes:
/// "ingest"; "ingest/reflection", "ingest/layers", "ingest/variance radiance" and "ingest/variance specular"
/// if there is something to do for them; "ingest/white" if an albedo is missing. Radiance, normal and depth
/// are required.
DenoiserInput ingest(gpu::FrameGraph& graph, const IngestImages& images, const IngestParams& params,
                     const IngestNeeds& needs);

}  // namespace limpid::denoise
