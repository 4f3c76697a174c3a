// Traces rays on the device, and provides scenes for that.
#pragma once

#include <array>
#include <random>

#include "shaders/trace/ray_shaders.h"
#include "tests/gpu/gpu_fixture.h"
#include "tests/reference/brute_force.h"
#include "trace_test.comp.h"
#include "trace_test.rgen.h"

namespace limpid::test {

struct TestHit {
    float t;  ///< negative: no hit
    vec2 barycentrics;
    uint32_t instance, primitive, any;
};

inline vec3 randomDirection(std::mt19937& random) {
    std::normal_distribution<float> normal;
    const vec3 v(normal(random), normal(random), normal(random));
    return glm::length(v) > 1e-3f ? glm::normalize(v) : vec3(0, 1, 0);
}

inline vec3 randomPoint(std::mt19937& random, const vec3& lower, const vec3& upper) {
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const vec3 u(uniform(random), uniform(random), uniform(random));
    return lower + u * (upper - lower);
}

/// A scene with one opaque material.
inline scene::Scene plainScene() {
    scene::Scene scene;
    scene.materials.emplace_back();
    scene.materials[0].metallic = 0.0f;
    scene.materials[0].specular = 0.0f;
    return scene;
}

inline void addInstance(scene::Scene& scene, int mesh, const mat4& transform = mat4(1.0f), int material = 0) {
    scene::Instance instance;
    instance.mesh = mesh;
    instance.material = material;
    instance.transform = transform;
    scene.instances.push_back(std::move(instance));
}

/// Triangles of mixed sizes, including slivers, in a cube of the given half size.
inline scene::Mesh triangleSoup(uint32_t count, float size, uint32_t seed) {
    scene::Mesh mesh;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> exponent(-2.5f, -0.3f);
    for (uint32_t i = 0; i < 3 * count; i += 3) {
        const vec3 center = randomPoint(random, vec3(-size), vec3(size));
        const float extent = size * std::pow(10.0f, exponent(random));
        for (uint32_t k = 0; k < 3; ++k) {
            const float sliver = i % 7 == 0 && k == 2 ? 0.02f : 1.0f;
            const vec3 from = sliver < 1.0f ? mesh.positions.back() : center;
            mesh.positions.push_back(from + sliver * randomPoint(random, vec3(-extent), vec3(extent)));
            mesh.indices.push_back(i + k);
        }
    }
    return mesh;
}

/// Every traversal test runs with both tracers, and with both traversals of the `compute` tracer.
class TraceTest : public GpuTest, public testing::WithParamInterface<scene::TraceOptions> {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || GetParam().tracer == scene::Tracer::Compute || device().info().rayTracing) return;
        GTEST_SKIP() << "NOT TESTED: " << device().info().name
                     << " has no ray-tracing pipelines; scripts/lavapipe25.sh fetches a driver that has.";
    }

    std::vector<TestHit> trace(const scene::Scene& scene, const std::vector<TestRay>& rays,
                               uint32_t seed = 1) {
        const scene::SceneData data = scene::buildSceneData(scene);
        const scene::GpuScene gpuScene(device(), data, GetParam());
        twoLevel_ = data.features.twoLevel;
        return traceThrough(gpuScene, rays, seed);
    }

    /// Uses the current state of the scene on the device.
    std::vector<TestHit> traceThrough(const scene::GpuScene& scene, const std::vector<TestRay>& rays,
                                      uint32_t seed = 1) {
        const auto count = static_cast<uint32_t>(rays.size());
        const uint32_t params[] = {scene.params().rootNode, count, seed};
        const gpu::Buffer buffer = upload("rays", rays);
        const bool hardware = scene.tracer() == scene::Tracer::Hardware;
        const Job job{.shader = hardware ? shaders::trace_test_rgen : shaders::trace_test_comp,
                      .scene = &scene,
                      .buffers = {{"rays", &buffer}},
                      .params = gpu::paramsOf(params),
                      .count = count,
                      .rays = hardware ? &rayShaders() : nullptr};
        return run<TestHit>(job, count);
    }

    bool twoLevel() const { return twoLevel_; }

  private:
    bool twoLevel_ = false;
};

inline std::string nameOf(const scene::TraceOptions& options) {
    if (!options.gpuTraversal) return std::string(scene::toString(options.tracer));
    return *options.gpuTraversal ? "compute_as_on_gpus" : "compute_as_on_cpus";
}

inline std::string nameOfTracer(const testing::TestParamInfo<scene::TraceOptions>& options) {
    return nameOf(options.param);
}

inline const std::array<scene::TraceOptions, 2> computeTracers{
    scene::TraceOptions{scene::Tracer::Compute, true}, scene::TraceOptions{scene::Tracer::Compute, false}};
inline const std::array<scene::TraceOptions, 3> allTracers{computeTracers[0], computeTracers[1],
                                                           scene::TraceOptions{scene::Tracer::Hardware, {}}};
/// The device's own traversal, and the driver's: enough where the subject is not how triangles are found.
inline const std::array<scene::TraceOptions, 2> ownTracers{scene::TraceOptions{scene::Tracer::Compute, {}},
                                                           scene::TraceOptions{scene::Tracer::Hardware, {}}};

}  // namespace limpid::test
