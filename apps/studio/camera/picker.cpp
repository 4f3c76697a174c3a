#include "studio/camera/picker.h"

#include "passes/deform/deform.h"
#include "passes/gbuffer/gbuffer.h"

namespace limpid::studio {

std::optional<vec3> Picker::pointSeen(scene::GpuScene& scene, const std::optional<scene::SceneFrame>& moved,
                                      const CameraParams& camera, gpu::Extent extent, uint32_t x,
                                      uint32_t y) {
    graph_.beginFrame();
    if (moved) deform(graph_, scene, *moved);
    GBufferSettings settings;
    settings.light = false;
    const CameraLaunch launch{.extent = extent, .camera = camera, .previousCamera = camera};
    const gpu::ImageHandle position = gbuffer(graph_, scene, settings, launch).position;
    graph_.execute(device_);
    const std::vector<float> pixels = graph_.downloadFloat(device_, position);
    const float* const found = &pixels[4 * (size_t{y} * extent.width + x)];
    if (found[3] == 0.0f) return std::nullopt;
    return vec3(found[0], found[1], found[2]);
}

}  // namespace limpid::studio
