// A denoiser as others embed it: what limpid/denoise.h opens, with exceptions in place of result codes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "denoise/api/parameter_numbers.h"
#include "denoise/methods/methods.h"
#include "denoise/stages/ingest/ingest.h"
#include "limpid/denoise.h"

namespace limpid::denoise {

/// What a frame leaves, rgba32f; empty where the method has none.
struct InstanceOutputs {
    gpu::ImageHandle color, radiance, specular;
};

const std::vector<InstanceParameter>& parametersOf(limpid_method method);

/// Throws UsageError if there is none of this name, or the value is outside its range.
void setParameter(FilterSettings& settings, limpid_method method, std::string_view name, double value);
double parameter(const FilterSettings& settings, limpid_method method, std::string_view name);

/// Throws Error if a value is none of its enumeration, or the size is 0.
void check(const limpid_denoiser_desc& desc);

/// What of the ingest pass's parameters follows from conventions and cameras. `hasPrevious`: this frame has a
/// predecessor.
IngestParams ingestParams(const limpid_denoiser_desc& desc, const limpid_camera& camera, bool hasPrevious);

/// Records a frame, needs no device. `outputs`: which are wanted, by limpid_output.
InstanceOutputs recordFrame(gpu::FrameGraph& graph, const limpid_denoiser_desc& desc,
                            const FilterSettings& settings, const IngestImages& images,
                            const IngestParams& params, gpu::Backing filters, bool signalsToo);

/// The name of an input, for messages and debuggers: "radiance".
const char* inputName(size_t input);

}  // namespace limpid::denoise
