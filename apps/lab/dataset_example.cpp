#include "lab/dataset_example.h"

#include <algorithm>
#include <cmath>

#include "renderer/frame/frame_renderer.h"
#include "renderer/layers/layers.h"
#include "scene/model/camera.h"

namespace limpid::cli {
namespace {

using image::Image;
using image::LayeredImage;

constexpr float largestHalf = 65504.0f;
constexpr uint32_t referenceSeed = 0x9E3779B9u;

/// Converts interleaved components to planar channels.
neural::Tensor tensorOf(const Image& picture) {
    const size_t pixels = size_t{picture.width} * picture.height;
    std::vector<float> values(pixels * picture.components);
    for (size_t p = 0; p < pixels; ++p) {
        for (uint32_t c = 0; c < picture.components; ++c) {
            const float value = picture.pixels[p * picture.components + c];
            values[c * pixels + p] =
                std::isfinite(value) ? std::clamp(value, -largestHalf, largestHalf) : 0.0f;
        }
    }
    return neural::makeTensor(neural::ElementType::Float16,
                              {picture.components, picture.height, picture.width}, values);
}

/// In files, depth is 1e10 where the ray misses; here it becomes 0.
Image distances(const LayeredImage& layers) {
    Image depth = layers.get("depth", "Z");
    for (float& z : depth.pixels) z = z < 1e9f ? z : 0.0f;
    return depth;
}

LayeredImage layersOf(FrameRenderer& still) {
    return toLayeredImage(still.download(), layerNames(), image::Storage::Float);
}

void addInputs(FrameRenderer& still, const std::string& prefix, neural::TensorFile& file) {
    const LayeredImage layers = layersOf(still);
    for (const char* name : {"diffuse", "specular", "albedo"})
        file.tensors[prefix + name] = tensorOf(layers.get(name, "RGB"));
    file.tensors[prefix + "normal"] = tensorOf(layers.get("normal", "XYZ"));
    file.tensors[prefix + "depth"] = tensorOf(distances(layers));
    for (const char* name : {"diffuse", "specular", "albedo", "normal", "depth"}) {
        Image variance(layers.width, layers.height, 1);
        variance.pixels = layers.find(std::string(name) + ".variance.V")->values;
        file.tensors[prefix + name + ".variance"] = tensorOf(variance);
    }
}

}  // namespace

void addExample(gpu::Device& device, scene::GpuScene& scene, const scene::Camera& camera,
                const ExampleSettings& settings, const std::string& name, neural::TensorFile& file) {
    const CameraParams view = scene::cameraParams(camera, settings.extent.width, settings.extent.height);
    RenderSettings render;
    render.extent = settings.extent;
    render.seed = settings.seed;
    render.jitter = settings.jitter;
    render.pathtrace.samplerSobol = false;  // so that the sets of the shipped weights can be made again
    render.layers = true;
    FrameRenderer noisy(device, scene, render, settings.samples.back());
    noisy.begin({.camera = view});
    for (const uint32_t count : settings.samples) {
        while (noisy.samplesInMean() < count) noisy.launch();
        addInputs(noisy, name + "/" + std::to_string(count) + "/", file);
    }
    render.seed ^= referenceSeed;
    render.samplesPerLaunch = 8;
    render.samplesPerLaunch = samplesPerLaunch(device, render);
    FrameRenderer reference(device, scene, render, settings.referenceSamples);
    reference.render({.camera = view});
    const LayeredImage layers = layersOf(reference);
    for (const char* side : {"diffuse", "specular"})
        file.tensors[name + "/reference/" + side] = tensorOf(layers.get(side, "RGB"));
}

}  // namespace limpid::cli
