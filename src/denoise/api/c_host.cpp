// The C interface's frames in host memory.
#include "denoise/api/c_guard.h"
#include "denoise/api/c_handles.h"
#include "denoise/api/host_pixels.h"

using namespace limpid;
using namespace limpid::denoise;

namespace {

std::vector<uint32_t> toUnsigned(const std::vector<float>& pixels) {
    std::vector<uint32_t> result;
    result.reserve(pixels.size());
    for (const float value : pixels)
        result.push_back(value >= 0.0f && value < 4294967040.0f ? static_cast<uint32_t>(value) : 0);
    return result;
}

/// Returns how many components an input has at least: those that it cannot do without.
uint32_t fewestOfInput(const limpid_denoiser_desc& desc, size_t input) {
    switch (input) {
        case LIMPID_INPUT_RADIANCE:
        case LIMPID_INPUT_SPECULAR:
        case LIMPID_INPUT_EMISSION:
        case LIMPID_INPUT_ALBEDO:
        case LIMPID_INPUT_ALBEDO_SPECULAR:
            return desc.method == LIMPID_METHOD_VISIBILITY ? 1 : 3;
        case LIMPID_INPUT_NORMAL:
        case LIMPID_INPUT_PREVIOUS_NORMAL:
            return desc.normal_encoding >= LIMPID_NORMAL_OCTAHEDRAL_SIGNED ? 2 : 3;
        case LIMPID_INPUT_MOTION:
        case LIMPID_INPUT_REFLECTION_MOTION:
            return desc.motion_depth == LIMPID_MOTION_DISTANCE ? 3 : 2;
        default:
            return 1;
    }
}

IngestImages uploadInputs(gpu::FrameGraph& graph, const limpid_denoiser_desc& desc,
                          const limpid_host_frame& frame) {
    const gpu::Extent extent{desc.width, desc.height};
    IngestImages images;
    for (size_t input = 0; input < LIMPID_INPUT_MAX; ++input) {
        if (!frame.inputs[input].data) continue;
        gpu::ImageHandle& handle = imageOf(images, input);
        const std::string name = std::string("input/") + inputName(input);
        const std::vector<float> pixels = readPixels(frame.inputs[input], desc.width, desc.height,
                                                     inputName(input), fewestOfInput(desc, input));
        const bool isId = input == LIMPID_INPUT_ID;
        handle = graph.transient(name, isId ? gpu::Format::RGBA32Uint : gpu::Format::RGBA32Float, extent);
        if (isId)
            graph.upload(handle, gpu::bytesOf(toUnsigned(pixels)));
        else
            graph.upload(handle, gpu::bytesOf(pixels));
    }
    requireInputs(desc, images);
    return images;
}

/// Returns how many components the method's outputs have at least.
uint32_t fewestComponents(const limpid_denoiser_desc& desc) {
    return desc.method == LIMPID_METHOD_VISIBILITY ? 1 : 3;
}

/// Throws UsageError if a picture cannot be written to where it is wanted, before any history advances.
void checkOutputs(const limpid_denoiser_desc& desc, const limpid_host_frame& frame) {
    for (size_t i = 0; i < std::size(outputNames); ++i)
        if (frame.outputs[i].data) checkOutput(frame.outputs[i], outputNames[i], fewestComponents(desc));
}

}  // namespace

extern "C" limpid_result limpid_denoise_host(limpid_denoiser* denoiser, const limpid_host_frame* given) {
    return guarded([&] {
        limpid_denoiser& d = required(denoiser, "denoiser");
        const limpid_host_frame frame = wholeStruct(given, "limpid_host_frame");
        if (d.adopted) throw UsageError("the device is the caller's: record frames with limpid_record()");
        checkOutputs(d.desc, frame);
        const bool hasPrevious = !d.startsAnew(frame.reset != 0);
        const IngestParams params = ingestParams(d.desc, frame.camera, hasPrevious);
        const limpid_host_output* wanted = frame.outputs;
        const bool signalsToo = wanted[LIMPID_OUTPUT_RADIANCE].data || wanted[LIMPID_OUTPUT_SPECULAR].data;
        d.graph.beginFrame();
        const IngestImages images = uploadInputs(d.graph, d.desc, frame);
        const InstanceOutputs outputs = recordFrame(d.graph, d.desc, d.settings, images, params,
                                                    gpu::filterChoice(*d.device), signalsToo, {});
        const gpu::ImageHandle made[] = {outputs.color, outputs.radiance, outputs.specular};
        for (size_t i = 0; i < LIMPID_OUTPUT_MAX; ++i)
            if (wanted[i].data && (i >= std::size(made) || !made[i]))
                throw UsageError(formatText("the method has no output {}",
                                            i < std::size(outputNames) ? outputNames[i] : "of this number"));
        d.graph.execute(*d.device);
        d.finish();
        d.device->waitIdle();  // downloads wait, too, but there may be none
        for (size_t i = 0; i < std::size(made); ++i) {
            if (!wanted[i].data) continue;
            writePixels(wanted[i], d.graph.downloadFloat(*d.device, made[i]), d.desc.width, d.desc.height,
                        outputNames[i], fewestComponents(d.desc));
        }
    });
}
