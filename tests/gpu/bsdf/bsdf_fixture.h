// Evaluates the BSDF on the device, with materials given by parameters.
#pragma once

#include "bsdf_evaluate.comp.h"
#include "bsdf_sample.comp.h"
#include "scene/builtin/mesh_builder.h"
#include "tests/gpu/gpu_fixture.h"
#include "tests/reference/sphere_quadrature.h"

namespace limpid::test {

/// The uniform block of shaders/bsdf_test.glsl.
struct BsdfParams {
    vec3 baseColor{1.0f};
    float metallic = 0.0f;
    vec3 toViewer{0, 0, 1};
    float roughness = 0.5f;
    vec3 normal{0, 0, 1};
    float specular = 1.0f;
    vec3 geometricNormal{0, 0, 1};
    float ior = 1.5f;
    vec3 specularColor{1.0f};
    float transmission = 0.0f;
    float clearcoat = 0.0f, clearcoatRoughness = 0.0f;
    vec3 clearcoatNormal{0, 0, 1};
    uint32_t thin = 1, front = 1;
    uint32_t count = 0, perThread = 8, seed = 1;
    float anisotropy = 0.0f;
    vec3 anisotropyDirection{1, 0, 0};
    vec3 sheenColor{0.0f};
    float sheenRoughness = 0.5f;
    vec3 diffuseTransmissionColor{1.0f};
    float diffuseTransmission = 0.0f;
    float iridescence = 0.0f, iridescenceIor = 1.3f, iridescenceThickness = 400.0f;

    bool isExtended() const {
        return anisotropy > 0.0f || sheenColor != vec3(0.0f) || diffuseTransmission > 0.0f ||
               iridescence > 0.0f;
    }
};

struct NamedMaterial {
    std::string name;
    BsdfParams params;
};

struct SampledDirection {
    vec3 direction;
    vec3 diffuse, specular;
    float pdf;
    uint32_t delta, valid;
};

struct EvaluatedDirection {
    vec3 diffuse, specular;
    float pdf;
};

/// Returns a direction in the xz plane, rotated by some azimuth so that no symmetry hides a wrong sign.
inline vec3 viewerAt(float cosine) {
    const float sine = std::sqrt(1.0f - cosine * cosine);
    return {sine * std::cos(0.7f), sine * std::sin(0.7f), cosine};
}

inline std::string describe(const NamedMaterial& m) {
    const BsdfParams& p = m.params;
    return fmt::format(
        "{}: baseColor {} {} {} metallic {} roughness {} specular {} ior {} transmission {} thin {} front {} "
        "clear coat {} of roughness {} anisotropy {} sheen {} of roughness {} diffuse transmission {} film "
        "{} "
        "of {} nm cosine {} seed {}",
        m.name, p.baseColor.r, p.baseColor.g, p.baseColor.b, p.metallic, p.roughness, p.specular, p.ior,
        p.transmission, p.thin, p.front, p.clearcoat, p.clearcoatRoughness, p.anisotropy, p.sheenColor.r,
        p.sheenRoughness, p.diffuseTransmission, p.iridescence, p.iridescenceThickness, p.toViewer.z, p.seed);
}

class BsdfTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped()) return;
        scene::Scene scene;
        scene.materials.emplace_back();
        scene.materials[0].metallic = 0.0f;
        scene.materials[0].transmission = 0.5f;
        scene.materials[0].thin = false;  // so that tests can use both panes and rough bodies
        scene.meshes.push_back(
            scene::MeshBuilder("triangle").triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).take());
        scene.instances.emplace_back();
        data_ = scene::buildSceneData(scene);
        plain_ = std::make_unique<scene::GpuScene>(device(), data_);
        scene.materials[0].clearcoat = 1.0f;
        coated_ = std::make_unique<scene::GpuScene>(device(), scene::buildSceneData(scene));
        scene.materials[0].anisotropy = scene.materials[0].diffuseTransmission = 0.5f;
        scene.materials[0].iridescence = 0.5f;
        scene.materials[0].sheenColor = vec3(1.0f);
        extended_ = std::make_unique<scene::GpuScene>(device(), scene::buildSceneData(scene));
    }

    std::vector<SampledDirection> sample(BsdfParams params, uint32_t count) {
        params.count = count;
        const Job job{.shader = shaders::bsdf_sample_comp,
                      .scene = sceneFor(params),
                      .params = gpu::paramsOf(params),
                      .count = count / params.perThread};
        return run<SampledDirection>(job, count);
    }

    std::vector<EvaluatedDirection> evaluate(BsdfParams params, const std::vector<vec3>& directions) {
        params.count = static_cast<uint32_t>(directions.size());
        const gpu::Buffer buffer = upload("directions", directions);
        const Job job{.shader = shaders::bsdf_evaluate_comp,
                      .scene = sceneFor(params),
                      .buffers = {{"directions", &buffer}},
                      .params = gpu::paramsOf(params),
                      .count = params.count};
        return run<EvaluatedDirection>(job, directions.size());
    }

    /// f is the first channel of f cos.
    SphereQuadrature integrate(const BsdfParams& params) {
        return SphereQuadrature([&](const std::vector<vec3>& directions) {
            std::vector<SphereValue> values;
            for (const EvaluatedDirection& e : evaluate(params, directions)) {
                values.push_back({double{e.pdf}, double{e.diffuse.r} + double{e.specular.r}});
            }
            return values;
        });
    }

    const scene::SceneData& data() const { return data_; }

  private:
    /// Uses a scene without what the material lacks: that runs a different shader variant.
    const scene::GpuScene* sceneFor(const BsdfParams& params) const {
        if (params.isExtended()) return extended_.get();
        return params.clearcoat > 0.0f ? coated_.get() : plain_.get();
    }

    scene::SceneData data_;
    std::unique_ptr<scene::GpuScene> plain_, coated_, extended_;
};

}  // namespace limpid::test
