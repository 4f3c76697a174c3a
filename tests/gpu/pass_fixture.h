// For tests of single passes: a scene, a graph, and images as pixels.
#pragma once

#include <cstring>

#include "passes/gbuffer/gbuffer.h"
#include "passes/pathtrace/pathtrace.h"
#include "tests/gpu/render_fixture.h"
#include "tests/gpu/trace/trace_fixture.h"

namespace limpid::test {

/// A scene on the device, and the graph for its frames.
struct Stage {
    scene::SceneData data;
    scene::GpuScene scene;
    gpu::FrameGraph graph;

    Stage(gpu::Device& device, const scene::Scene& source, const scene::TraceOptions& options)
        : data(scene::buildSceneData(source)), scene(device, data, options) {}
};

/// Rays go through the pixels' centres.
inline CameraLaunch centredLaunch(const scene::Scene& scene, gpu::Extent extent) {
    CameraLaunch launch;
    launch.extent = extent;
    launch.camera = launch.previousCamera =
        scene::cameraParams(scene.cameras.at(0), extent.width, extent.height);
    launch.jitter = Jitter::Off;
    return launch;
}

inline PathtraceLaunch pathLaunch(const CameraLaunch& launch) {
    return {launch, 1};
}

/// Every test runs with both tracers, and with both traversals of the `compute` tracer.
class PassTest : public TraceTest {
  protected:
    std::vector<vec4> pixels(Stage& stage, gpu::ImageHandle image) {
        const std::vector<float> values = stage.graph.downloadFloat(device(), image);
        std::vector<vec4> result(values.size() / 4);
        std::memcpy(result.data(), values.data(), values.size() * sizeof(float));
        return result;
    }

    /// Renders a frame of the G-buffer alone.
    GBufferImages look(Stage& stage, const CameraLaunch& launch, const GBufferSettings& settings = {}) {
        stage.graph.beginFrame();
        const GBufferImages images = gbuffer(stage.graph, stage.scene, settings, launch);
        stage.graph.execute(device());
        return images;
    }
};

}  // namespace limpid::test
