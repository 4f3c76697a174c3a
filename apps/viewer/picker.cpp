#include "picker.h"

#include "passes/gbuffer/gbuffer.h"

namespace limpid::viewer {

std::optional<vec3> pointSeen(gpu::Device& device, scene::GpuScene& scene, const CameraParams& camera,
                              gpu::Extent extent, uint32_t x, uint32_t y) {
    gpu::FrameGraph graph;
    graph.beginFrame();
    GBufferSettings settings;
    settings.light = false;
    const CameraLaunch launch{.extent = extent, .camera = camera, .previousCamera = camera};
    const gpu::ImageHandle position = gbuffer(graph, scene, settings, launch).position;
    graph.execute(device);
    const std::vector<float> pixels = graph.downloadFloat(device, position);
    const float* const found = &pixels[4 * (size_t{y} * extent.width + x)];
    if (found[3] == 0.0f) return std::nullopt;
    return vec3(found[0], found[1], found[2]);
}

}  // namespace limpid::viewer
