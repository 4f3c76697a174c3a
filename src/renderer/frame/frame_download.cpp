#include "renderer/frame/frame_download.h"

#include <algorithm>

#include "base/error.h"

namespace limpid {
namespace {

bool isUint(gpu::Format format) {
    return format == gpu::Format::R32Uint || format == gpu::Format::RG32Uint ||
           format == gpu::Format::RGBA32Uint;
}

void download(gpu::FrameGraph& graph, gpu::Device& device, gpu::ImageHandle image,
              std::vector<float>& pixels) {
    if (image) pixels = graph.downloadFloat(device, image);
}
void download(gpu::FrameGraph& graph, gpu::Device& device, gpu::ImageHandle image,
              std::vector<uint32_t>& pixels) {
    if (image) pixels = graph.downloadUint(device, image);
}

}  // namespace

RenderCounters sumCounters(std::span<const uint32_t> pixels) {
    RenderCounters sum;
    for (size_t i = 0; i + 1 < pixels.size(); i += 2) {
        sum.rays += pixels[i];
        sum.rejected += pixels[i + 1];
    }
    return sum;
}

std::vector<std::pair<std::string, image::Image>> imagesOfPass(gpu::FrameGraph& graph, gpu::Device& device,
                                                               const std::string& pass) {
    std::vector<gpu::ImageHandle> handles = graph.imagesWrittenBy(pass);
    if (handles.empty()) {
        std::string names;
        for (const gpu::RecordedPass& recorded : graph.passes()) names += " " + recorded.name;
        throw UsageError("there is no pass '" + pass + "' in this frame; its passes are" + names);
    }
    for (const gpu::ImageHandle previous : graph.previousReadBy(pass)) handles.push_back(previous);
    std::vector<std::pair<std::string, image::Image>> result;
    for (const gpu::ImageHandle handle : handles) {
        const gpu::Extent extent = graph.extent(handle);
        image::Image picture(extent.width, extent.height, gpu::componentCount(graph.format(handle)));
        if (isUint(graph.format(handle))) {
            const std::vector<uint32_t> values = graph.downloadUint(device, handle);
            std::transform(values.begin(), values.end(), picture.pixels.begin(),
                           [](uint32_t v) { return static_cast<float>(v); });
        } else {
            picture.pixels = graph.downloadFloat(device, handle);
        }
        result.emplace_back(graph.name(handle), std::move(picture));
    }
    return result;
}

RenderedLayers downloadLayers(gpu::FrameGraph& graph, gpu::Device& device, const FrameImages& images,
                              uint64_t samples) {
    const gpu::ImageHandle any = images.beauty ? images.beauty : images.diffuse;
    if (!any) throw Error("nothing has been rendered yet");
    RenderedLayers layers;
    layers.extent = graph.extent(any);
    layers.samples = samples;
    download(graph, device, images.beauty, layers.beauty);
    layers.forEach(
        [&](const LayerInfo& layer, auto& pixels) { download(graph, device, images[layer], pixels); });
    return layers;
}

}  // namespace limpid
