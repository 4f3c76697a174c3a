// Renders small pictures, and provides scenes of known brightness.
#pragma once

#include <cmath>

#include "renderer/frame/frame_renderer.h"
#include "scene/builtin/mesh_builder.h"
#include "scene/model/camera.h"
#include "tests/gpu/gpu_fixture.h"

namespace limpid::test {

using glm::dvec3;

struct Rendered {
    RenderedLayers layers;
    RenderCounters counters;

    vec3 beauty(size_t pixel) const {
        const float* p = &layers.beauty[4 * pixel];
        return {p[0], p[1], p[2]};
    }
    size_t pixelCount() const { return size_t{layers.extent.width} * layers.extent.height; }
};

inline scene::Material lambertian(const vec3& albedo) {
    scene::Material material;
    material.baseColor = vec4(albedo, 1.0f);
    material.metallic = material.specular = 0.0f;
    return material;
}

inline void addMesh(scene::Scene& scene, scene::Mesh mesh, const scene::Material& material) {
    scene::Instance instance;
    instance.mesh = static_cast<int>(scene.meshes.size());
    instance.material = static_cast<int>(scene.materials.size());
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(material);
    scene.instances.push_back(std::move(instance));
}

/// A square of side 20 in the plane y = 0, front upwards.
inline scene::Scene floorScene(const vec3& albedo) {
    scene::Scene scene;
    scene::MeshBuilder builder("floor");
    builder.quad({-10, 0, 10}, {10, 0, 10}, {10, 0, -10}, {-10, 0, -10});
    addMesh(scene, builder.take(), lambertian(albedo));
    return scene;
}

/// Returns where the ray through a pixel's centre hits the plane y = 0.
inline dvec3 floorPoint(const CameraParams& camera, gpu::Extent extent, uint32_t x, uint32_t y) {
    const double px = 2.0 * (x + 0.5) / extent.width - 1.0, py = 1.0 - 2.0 * (y + 0.5) / extent.height;
    const dvec3 direction = dvec3(camera.forward) + px * dvec3(camera.right) + py * dvec3(camera.up);
    return dvec3(camera.origin) - direction * (double{camera.origin.y} / direction.y);
}

/// Renders one scene repeatedly: the pipelines are compiled once.
class Renderer {
  public:
    Renderer(gpu::Device& device, const scene::Scene& scene, scene::Tracer tracer = scene::Tracer::Compute)
        : camera_(scene.cameras.at(0)),
          gpuScene_(device, scene::buildSceneData(scene), {tracer, {}}),
          still_(device, gpuScene_, {}, UINT64_MAX) {}

    /// `samples` must be a multiple of the samples per launch.
    Rendered operator()(const RenderSettings& settings, uint64_t samples) {
        if (samples % settings.samplesPerLaunch != 0)
            throw Error("samples are no multiple of those per launch");
        const gpu::Extent extent = settings.extent;
        still_.setSettings(settings);
        still_.begin({.camera = scene::cameraParams(camera_, extent.width, extent.height)});
        do {
            still_.launch();
        } while (still_.samplesInMean() < samples);
        return {still_.download(), still_.counters()};
    }

  private:
    scene::Camera camera_;
    scene::GpuScene gpuScene_;
    FrameRenderer still_;
};

class RenderTest : public GpuTest {
  protected:
    /// For SetUp(): skips the test if the device lacks the tracer.
    void requireTracer(scene::Tracer tracer) {
        if (IsSkipped() || tracer != scene::Tracer::Hardware || device().info().rayTracing) return;
        GTEST_SKIP() << "NOT TESTED: " << device().info().name
                     << " has no ray-tracing pipelines; scripts/lavapipe25.sh fetches a driver that has.";
    }

    Rendered render(const scene::Scene& scene, const RenderSettings& settings, uint64_t samples) {
        return Renderer(device(), scene)(settings, samples);
    }

    static CameraParams camera(const scene::Scene& scene, const RenderSettings& settings) {
        return scene::cameraParams(scene.cameras.at(0), settings.extent.width, settings.extent.height);
    }

    /// Settings with rays through the pixels' centres: every sample of a pixel sees the same point.
    static RenderSettings centred(uint32_t width, uint32_t height, int maxDepth) {
        RenderSettings settings;
        settings.extent = {width, height};
        settings.jitter = Jitter::Off;
        settings.pathtrace.maxDepth = maxDepth;
        return settings;
    }

    static double meanOfRed(const Rendered& picture) {
        double sum = 0.0;
        for (size_t i = 0; i < picture.pixelCount(); ++i) sum += double{picture.beauty(i).r};
        return sum / static_cast<double>(picture.pixelCount());
    }
};

}  // namespace limpid::test
