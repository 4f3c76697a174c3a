#include "denoise/api/denoiser_input.h"

#include <string>

#include "base/error.h"

namespace limpid::denoise {

DenoiserInput upload(gpu::FrameGraph& graph, const HostFrame& frame) {
    const gpu::Extent extent{frame.width, frame.height};
    const auto image = [&](const char* name, const std::vector<float>& pixels) {
        if (pixels.size() != 4 * frame.pixelCount())
            throw Error(std::string("the frame's image '") + name + "' has another size than the frame");
        const gpu::ImageHandle handle =
            graph.transient(std::string("input/") + name, gpu::Format::RGBA32Float, extent);
        graph.upload(handle, gpu::bytesOf(pixels));
        return handle;
    };
    DenoiserInput input;
    input.diffuse = image("diffuse", frame.diffuse);
    input.specular = image("specular", frame.specular);
    input.emission = image("emission", frame.emission);
    input.albedo = image("albedo", frame.albedo);
    const auto optionalImage = [&](const char* name, const std::vector<float>& pixels) {
        return image(name, pixels.empty() ? std::vector<float>(4 * frame.pixelCount()) : pixels);
    };
    input.albedoSpecular = optionalImage("albedoSpecular", frame.albedoSpecular);
    input.normal = image("normal", frame.normal);
    input.depth = image("depth", frame.depth);
    input.motion = image("motion", frame.motion);
    input.reflectionMotion = optionalImage("reflectionMotion", frame.reflectionMotion);
    input.previousNormal = image("previous_normal", frame.previousNormal);
    if (frame.ids.size() != 2 * frame.pixelCount())
        throw Error("the frame's image 'ids' has another size than the frame");
    input.ids = graph.transient("input/ids", gpu::Format::RG32Uint, extent);
    graph.upload(input.ids, gpu::bytesOf(frame.ids));
    input.camera = frame.camera;
    input.samples = frame.samples;
    return input;
}

}  // namespace limpid::denoise
