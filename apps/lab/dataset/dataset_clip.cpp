#include "lab/dataset/dataset_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "cli/cluster/session.h"
#include "lab/dataset/dataset_example.h"
#include "lab/dataset/dataset_tensor.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/layers/layers.h"

namespace limpid::cli {
namespace {

using image::Image;
using image::LayeredImage;

/// The seed of the second references differs by these bits from that of the first ones.
constexpr uint32_t secondReferenceSeed = 0x51ED270Bu;

/// The image whose name ends so, among those that the pass writes.
gpu::ImageHandle imageOf(const gpu::FrameGraph& graph, const std::string& pass, std::string_view ending) {
    for (const gpu::ImageHandle image : graph.imagesWrittenBy(pass)) {
        if (graph.name(image).ends_with(ending)) return image;
    }
    throw Error(fmt::format("the pass '{}' writes no image '{}'", pass, ending));
}

/// The same, of floats, on the host.
Image pictureOf(gpu::Device& device, gpu::FrameGraph& graph, const std::string& pass,
                std::string_view ending) {
    const gpu::ImageHandle image = imageOf(graph, pass, ending);
    const gpu::Extent extent = graph.extent(image);
    std::vector<float> pixels = graph.downloadFloat(device, image);
    const size_t components = pixels.size() / (size_t{extent.width} * extent.height);
    Image picture(extent.width, extent.height, static_cast<uint32_t>(components));
    picture.pixels = std::move(pixels);
    return picture;
}

/// svgf_stable.glsl: three signed numbers of 9 bits, and an exponent of 5 bits.
Image stableLight(gpu::Device& device, gpu::FrameGraph& graph, gpu::ImageHandle image) {
    const gpu::Extent extent = graph.extent(image);
    Image picture(extent.width, extent.height, 3);
    const std::vector<uint32_t> texels = graph.downloadUint(device, image);
    for (size_t p = 0; p < texels.size(); ++p) {
        for (uint32_t c = 0; c < 3; ++c) {
            const int whole = static_cast<int>(texels[p] << (23 - 9 * c)) >> 23;
            picture.pixels[3 * p + c] =
                std::ldexp(static_cast<float>(whole), static_cast<int>(texels[p] >> 27) - 23);
        }
    }
    return picture;
}

Image componentOf(const Image& picture, uint32_t number) {
    Image result(picture.width, picture.height, 1);
    for (size_t p = 0; p < result.pixels.size(); ++p)
        result.pixels[p] = picture.pixels[p * picture.components + number];
    return result;
}

neural::Tensor cameraTensor(const CameraParams& camera) {
    std::vector<float> values;
    for (const vec3& v : {camera.right, camera.up, camera.forward, camera.origin})
        values.insert(values.end(), {v.x, v.y, v.z});
    return neural::makeTensor(neural::ElementType::Float32, {4, 3}, values);
}

/// What the filter saw and made of the frame that `renderer` has rendered.
void addFrame(gpu::Device& device, FrameRenderer& renderer, const std::string& prefix,
              neural::TensorFile& file) {
    gpu::FrameGraph& graph = renderer.graph();
    const std::string lastLevel = fmt::format("svgf/level {}", denoise::SvgfSettings{}.levels);
    for (const std::string signal : {"diffuse", "specular"}) {
        const std::string reproject = "svgf/reproject " + signal;
        file.tensors[prefix + signal] =
            tensorOf(pictureOf(device, graph, "svgf/variance " + signal, "color"));
        file.tensors[prefix + signal + ".first"] = tensorOf(pictureOf(device, graph, "svgf/level 1", signal));
        file.tensors[prefix + signal + ".svgf"] = tensorOf(pictureOf(device, graph, lastLevel, signal));
        file.tensors[prefix + signal + ".past"] =
            tensorOf(stableLight(device, graph, imageOf(graph, reproject, "stable past")));
        file.tensors[prefix + signal + ".frames"] =
            tensorOf(componentOf(pictureOf(device, graph, reproject, "moments"), 3));
    }
    const RenderedLayers rendered = renderer.download();
    Image filtered(rendered.extent.width, rendered.extent.height, 4);
    filtered.pixels = rendered.beauty;
    file.tensors[prefix + "svgf"] = tensorOf(filtered);
    const LayeredImage layers = toLayeredImage(rendered, layerNames(), image::Storage::Float);
    for (const char* name : {"albedo", "albedoSpecular", "emission"})
        file.tensors[prefix + name] = tensorOf(layers.get(name, "RGB"));
    file.tensors[prefix + "normal"] = tensorOf(layers.get("normal", "XYZ"));
    file.tensors[prefix + "roughness"] = tensorOf(layers.get("roughness", "R"));
    file.tensors[prefix + "depth"] = tensorOf(distancesOf(layers));
    file.tensors[prefix + "motion"] = tensorOf(layers.get("motion", "XY"));
}

RenderSettings noisySettings(const ClipSettings& settings) {
    RenderSettings render;
    render.extent = settings.extent;
    render.seed = settings.seed;
    render.jitter = settings.jitter;
    render.pipeline = parsePipeline("path", settings.denoiser);
    render.samplesPerLaunch = settings.samples;
    render.layers = true;
    return render;
}

/// The clean beauty of the moment.
neural::Tensor referenceOf(FrameRenderer& renderer, const Moment& moment) {
    renderer.begin(moment);
    while (renderer.launch()) {
        if (ranks()) ranks()->beat();
    }
    return tensorOf(beautyOf(renderer.download()));
}

}  // namespace

void addClip(gpu::Device& device, scene::GpuScene& scene, const Sequence& sequence,
             const ClipSettings& settings, const std::string& name, neural::TensorFile& file) {
    RenderSettings render = noisySettings(settings);
    FrameRenderer noisy(device, scene, render, settings.samples);
    render.seed ^= referenceSeed;
    render.pipeline.denoiser = nullptr;
    render.pathtrace.samplerSobol = false;  // shares no points with the noisy frames
    render.samplesPerLaunch = 64;
    render.samplesPerLaunch = samplesPerLaunch(device, render);
    FrameRenderer clean(device, scene, render, settings.referenceSamples);
    render.seed ^= secondReferenceSeed;
    FrameRenderer cleanToo(device, scene, render, settings.referenceSamples);
    for (uint32_t frame = 0; frame <= settings.frames.back(); ++frame) {
        const Moment moment = sequence.moment(frame, settings.extent);
        noisy.render(moment);
        if (ranks()) ranks()->beat();
        if (!std::ranges::binary_search(settings.frames, frame)) continue;
        const std::string prefix = fmt::format("{}/{}/", name, frame);
        addFrame(device, noisy, prefix, file);
        file.tensors[prefix + "camera"] = cameraTensor(moment.camera);
        file.tensors[prefix + "reference"] = referenceOf(clean, moment);
        file.tensors[prefix + "reference2"] = referenceOf(cleanToo, moment);
    }
}

}  // namespace limpid::cli
