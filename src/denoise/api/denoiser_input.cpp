#include "denoise/api/denoiser_input.h"

#include <string>

#include "base/error.h"

namespace limpid::denoise {
namespace {

template <typename T>
gpu::ImageHandle uploadImage(gpu::FrameGraph& graph, const HostFrame& frame, const LayerInfo& layer,
                             const std::vector<T>& pixels, bool borrowed) {
    const bool integers = layer.stored == Stored::Uint;
    const size_t size = (integers ? 2 : 4) * frame.pixelCount();
    const bool absent = pixels.empty() && layer.need == Need::Optional;
    const std::string name(layer.member);
    if (!absent && pixels.size() != size)
        throw Error("the frame's image '" + name + "' has another size than the frame");
    const gpu::Format format = integers ? gpu::Format::RG32Uint : gpu::Format::RGBA32Float;
    const gpu::ImageHandle image = graph.transient("input/" + name, format, {frame.width, frame.height});
    const std::vector<T> zeros(absent ? size : 0);
    if (borrowed && !absent)
        graph.uploadBorrowed(image, gpu::bytesOf(pixels));
    else
        graph.upload(image, gpu::bytesOf(absent ? zeros : pixels));
    return image;
}

DenoiserInput uploadFrame(gpu::FrameGraph& graph, const HostFrame& frame, bool borrowed) {
    DenoiserInput input;
    frame.forEach([&](const LayerInfo& layer, const auto& pixels) {
        // Zeros of the first two would be those of a perfect mirror; without specular light there is one
        // signal.
        const bool ofSpecular = layer.member == "specular" || layer.member == "albedoSpecular";
        const bool mayLack = layer.member == "roughness" || layer.member == "hitDistance" ||
                             (ofSpecular && frame.specular.empty());
        if (mayLack && pixels.empty()) return;
        input[layer] = uploadImage(graph, frame, layer, pixels, borrowed);
    });
    input.camera = frame.camera;
    input.samples = frame.samples;
    input.variances = frame.variances;
    input.jitter = frame.jitter.value_or(vec2(0.0f));
    input.jitterChanges = frame.jitter.has_value();
    return input;
}

}  // namespace

DenoiserInput upload(gpu::FrameGraph& graph, const HostFrame& frame) {
    return uploadFrame(graph, frame, false);
}

DenoiserInput uploadBorrowed(gpu::FrameGraph& graph, const HostFrame& frame) {
    return uploadFrame(graph, frame, true);
}

}  // namespace limpid::denoise
