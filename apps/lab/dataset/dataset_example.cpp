#include "lab/dataset/dataset_example.h"

#include "cli/cluster/session.h"
#include "lab/dataset/dataset_tensor.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/layers/layers.h"
#include "scene/model/camera.h"

namespace limpid::cli {
namespace {

using image::Image;
using image::LayeredImage;

LayeredImage layersOf(FrameRenderer& still) {
    return toLayeredImage(still.download(), layerNames(), image::Storage::Float);
}

void addInputs(FrameRenderer& still, const std::string& prefix, neural::TensorFile& file) {
    const LayeredImage layers = layersOf(still);
    for (const char* name : {"diffuse", "specular", "albedo"})
        file.tensors[prefix + name] = tensorOf(layers.get(name, "RGB"));
    file.tensors[prefix + "normal"] = tensorOf(layers.get("normal", "XYZ"));
    file.tensors[prefix + "depth"] = tensorOf(distancesOf(layers));
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
        if (ranks()) ranks()->beat();
        addInputs(noisy, name + "/" + std::to_string(count) + "/", file);
    }
    render.seed ^= referenceSeed;
    render.samplesPerLaunch = 8;
    render.samplesPerLaunch = samplesPerLaunch(device, render);
    FrameRenderer reference(device, scene, render, settings.referenceSamples);
    reference.begin({.camera = view});
    while (reference.launch()) {
        if (ranks()) ranks()->beat();
    }
    const LayeredImage layers = layersOf(reference);
    for (const char* side : {"diffuse", "specular"})
        file.tensors[name + "/reference/" + side] = tensorOf(layers.get(side, "RGB"));
}

}  // namespace limpid::cli
