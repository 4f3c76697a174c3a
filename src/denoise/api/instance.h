// A denoiser for embedding: the C++ side of limpid/denoise.h, with exceptions in place of result codes.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "denoise/api/parameter_numbers.h"
#include "denoise/methods/methods.h"
#include "denoise/stages/ingest/ingest.h"
#include "limpid/denoise.h"

namespace limpid::denoise {

/// A frame's outputs: rgba32f, or the target of recordFrame(). Empty if the method does not produce them.
struct InstanceOutputs {
    gpu::ImageHandle color, radiance, specular;
};

const std::vector<InstanceParameter>& parametersOf(limpid_method method);

/// Throws UsageError if there is no such parameter, or the value is outside its range or a fraction for an
/// int or a bool.
void setParameter(FilterSettings& settings, limpid_method method, std::string_view name, double value);
double parameter(const FilterSettings& settings, limpid_method method, std::string_view name);

/// Throws UsageError if an enumeration's value, the number of signals or of frames in flight or the far depth
/// is invalid, or a side does not have 1 to 32768 pixels.
void check(const limpid_denoiser_desc& desc);

/// Whether frames depend on earlier ones: the method keeps a history, or anti-aliasing does.
bool readsHistory(const limpid_denoiser_desc& desc, const FilterSettings& settings);

/// Returns the ingest pass's parameters that follow from conventions and cameras. `hasPrevious`: there is a
/// previous frame; without, the camera's previous matrices are not read. Throws UsageError if the jitter or a
/// matrix is not as limpid_camera says.
IngestParams ingestParams(const limpid_denoiser_desc& desc, const limpid_camera& camera, bool hasPrevious);

/// Records a frame; needs no device. `signalsToo`: radiance and specular are wanted. `target`: the caller's
/// image for the colour, or empty; the method may write it itself, and it is then what is returned.
InstanceOutputs recordFrame(gpu::FrameGraph& graph, const limpid_denoiser_desc& desc,
                            const FilterSettings& settings, const IngestImages& images,
                            const IngestParams& params, const gpu::FilterChoice& choice, bool signalsToo,
                            gpu::ImageHandle target);

inline constexpr size_t inputCount = LIMPID_INPUT_SPECULAR_VARIANCE + 1;
/// Returns the name of an input for messages and debuggers, such as "radiance".
const char* inputName(size_t input);
/// Likewise of the outputs, in the order of limpid_output.
inline constexpr std::array<const char*, 3> outputNames{"color", "radiance", "specular"};

}  // namespace limpid::denoise
