// Tests traversal where the answer is known without a second tracer: closed bodies, and transparent
// materials.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/mesh_builder.h"
#include "tests/gpu/trace/trace_fixture.h"

namespace limpid::test {
namespace {

class WatertightTest : public TraceTest {
  protected:
    /// Returns rays from inside towards points on edges and at vertices of every triangle.
    static std::vector<TestRay> raysAtEdges(const scene::Mesh& mesh, const mat4& transform, const vec3& lower,
                                            const vec3& upper, uint32_t count) {
        std::mt19937 random(17);
        std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
        std::vector<TestRay> rays;
        while (rays.size() < count) {
            const size_t triangle = random() % mesh.triangleCount(), corner = random() % 3;
            const vec3 a = mesh.positions[mesh.indices[3 * triangle + corner]];
            const vec3 b = mesh.positions[mesh.indices[3 * triangle + (corner + 1) % 3]];
            const float t = rays.size() % 4 == 0 ? 0.0f : uniform(random);
            const vec3 target(transform * vec4(a + t * (b - a), 1.0f));
            const vec3 origin(transform * vec4(randomPoint(random, lower, upper), 1.0f));
            rays.push_back({origin, glm::normalize(target - origin), 1e30f});
        }
        return rays;
    }

    void expectNoEscape(const scene::Scene& scene, const std::vector<TestRay>& rays,
                        const std::string& name) {
        const std::vector<TestHit> hits = trace(scene, rays);
        uint32_t escaped = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            if (hits[i].t >= 0.0f && hits[i].any != 0) continue;
            const TestRay& r = rays[i];
            if (++escaped > 3) continue;
            ADD_FAILURE() << fmt::format(
                "{}: ray {} escaped (any {}): origin {:.9g} {:.9g} {:.9g} direction {:.9g} {:.9g} {:.9g}",
                name, i, hits[i].any, r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y,
                r.direction.z);
        }
        EXPECT_EQ(escaped, 0u) << name << ": of " << rays.size();
        fmt::print("{}: {} of {} rays escaped\n", name, escaped, rays.size());
    }

    void check(const scene::Mesh& mesh, const vec3& lower, const vec3& upper, uint32_t count,
               const std::string& name) {
        const mat4 turned = glm::rotate(mat4(1.0f), 0.6f, glm::normalize(vec3(1, 2, 3)));
        const mat4 far = glm::translate(mat4(1.0f), vec3(1000, -300, 50)) * turned;
        const mat4 tiny = glm::scale(mat4(1.0f), vec3(1e-3f)) * turned;
        for (const auto& [transform, where] :
             {std::pair{mat4(1.0f), ""}, {turned, ", turned"}, {far, ", far"}, {tiny, ", tiny"}}) {
            scene::Scene scene = plainScene();
            scene.meshes.push_back(mesh);
            addInstance(scene, 0, transform);
            expectNoEscape(scene, raysAtEdges(mesh, transform, lower, upper, count), name + where);
        }
    }
};

/// Merges the vertices of each pole, which the sine of pi spreads by 1e-7, so that the mesh itself is closed.
scene::Mesh closedSphere() {
    scene::MeshBuilder builder("sphere");
    builder.sphere(vec3(0.0f), 1.0f, 48, 24);
    scene::Mesh mesh = builder.take();
    for (vec3& p : mesh.positions) {
        if (std::abs(p.x) + std::abs(p.z) < 1e-6f) p = vec3(0.0f, p.y > 0.0f ? 1.0f : -1.0f, 0.0f);
    }
    return mesh;
}

TEST_P(WatertightTest, Sphere) {
    check(closedSphere(), vec3(-0.5f), vec3(0.5f), 100000, "sphere");
}

TEST_P(WatertightTest, Box) {
    scene::MeshBuilder builder("box");
    builder.box(vec3(-1, -2, -0.5f), vec3(1, 1, 3));
    check(builder.take(), vec3(-0.99f, -1.9f, -0.4f), vec3(0.99f, 0.9f, 2.9f), 100000, "box");
}

/// Many instances of one closed mesh: rays from inside the first one, whose own space is rotated and scaled.
TEST_P(WatertightTest, InstancedSphere) {
    scene::Scene scene = plainScene();
    scene.meshes.push_back(closedSphere());
    mat4 first = glm::rotate(mat4(1.0f), 1.1f, glm::normalize(vec3(3, -1, 2)));
    first = glm::scale(first, vec3(2.0f, 0.7f, -1.3f));
    addInstance(scene, 0, first);
    for (int i = 1; i < 4; ++i)
        addInstance(scene, 0, glm::translate(mat4(1.0f), vec3(10.0f * static_cast<float>(i), 0, 0)));
    expectNoEscape(scene, raysAtEdges(scene.meshes[0], first, vec3(-0.5f), vec3(0.5f), 100000),
                   "instanced sphere");
    EXPECT_TRUE(twoLevel());
}

/// The same instances, of meshes whose own units are nanometres, or gigametres.
TEST_P(WatertightTest, InstancedSphereInOtherUnits) {
    for (const float unit : {1e9f, 1e-9f}) {
        scene::Scene scene = plainScene();
        scene.meshes.push_back(closedSphere());
        for (vec3& p : scene.meshes[0].positions) p *= unit;
        const mat4 metres = glm::scale(mat4(1.0f), vec3(1.0f / unit));
        const mat4 first = glm::rotate(metres, 1.1f, glm::normalize(vec3(3, -1, 2)));
        addInstance(scene, 0, first);
        for (int i = 1; i < 4; ++i)
            addInstance(scene, 0,
                        glm::translate(mat4(1.0f), vec3(10.0f * static_cast<float>(i), 0, 0)) * metres);
        expectNoEscape(scene,
                       raysAtEdges(scene.meshes[0], first, vec3(-0.5f * unit), vec3(0.5f * unit), 20000),
                       fmt::format("instanced sphere of size {}", unit));
        EXPECT_TRUE(twoLevel());
    }
}

class AlphaTest : public TraceTest {
  protected:
    /// Two squares behind each other: the first of the tested material, then an opaque one.
    static scene::Scene twoSquares(const scene::Material& front) {
        scene::Scene scene = plainScene();
        scene.materials.push_back(front);
        for (const float z : {-1.0f, -2.0f}) {
            scene::MeshBuilder builder("square");
            builder.quad({-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z});
            scene.meshes.push_back(builder.take());
            scene.meshes.back().uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
            addInstance(scene, z == -1.0f ? 0 : 1, mat4(1.0f), z == -1.0f ? 1 : 0);
        }
        return scene;
    }

    static std::vector<TestRay> forwardRays(uint32_t count) {
        std::mt19937 random(3);
        std::vector<TestRay> rays;
        for (uint32_t i = 0; i < count; ++i) {
            rays.push_back(
                {randomPoint(random, vec3(-0.95f, -0.95f, 0), vec3(0.95f, 0.95f, 0)), {0, 0, -1}, 1e30f});
        }
        return rays;
    }

    /// Returns how many of `count` rays hit the first square, and how many any-hit rays that end before the
    /// second one do.
    std::pair<double, double> blocked(const scene::Scene& scene, uint32_t count) {
        std::vector<TestRay> rays = forwardRays(count);
        double closest = 0, any = 0;
        for (const TestHit& hit : trace(scene, rays)) {
            EXPECT_GE(hit.t, 0.0f) << "the opaque square behind was missed";
            closest += hit.t < 1.5f;
        }
        for (TestRay& ray : rays) ray.tMax = 1.5f;
        for (const TestHit& hit : trace(scene, rays, 2)) any += hit.any;
        return {closest, any};
    }
};

TEST_P(AlphaTest, MaskComparesWithTheCutoff) {
    scene::Material material;
    material.alphaMode = scene::AlphaMode::Mask;
    for (const auto& [alpha, cutoff, expected] :
         {std::tuple{0.4f, 0.5f, 0.0}, {0.5f, 0.5f, 1000.0}, {0.2f, 0.1f, 1000.0}}) {
        material.baseColor.a = alpha;
        material.alphaCutoff = cutoff;
        const auto [closest, any] = blocked(twoSquares(material), 1000);
        EXPECT_EQ(closest, expected) << "alpha " << alpha << " cutoff " << cutoff;
        EXPECT_EQ(any, expected) << "alpha " << alpha << " cutoff " << cutoff;
    }
}

TEST_P(AlphaTest, BlendPassesItsShare) {
    scene::Material material;
    material.alphaMode = scene::AlphaMode::Blend;
    constexpr uint32_t count = 20000;
    for (const double alpha : {0.0, 0.3, 0.9, 1.0}) {
        material.baseColor.a = static_cast<float>(alpha);
        const auto [closest, any] = blocked(twoSquares(material), count);
        const double sigma = std::sqrt(count * alpha * (1.0 - alpha));
        EXPECT_NEAR(closest, alpha * count, 4.0 * sigma) << "alpha " << alpha;
        EXPECT_NEAR(any, alpha * count, 4.0 * sigma) << "alpha " << alpha;
    }
}

/// A texture's alpha decides per texel; vertex colours multiply it.
TEST_P(AlphaTest, MaskFromTextureAndVertexColours) {
    scene::Material material;
    material.alphaMode = scene::AlphaMode::Mask;
    material.baseColorTexture.texture = 0;
    scene::Scene scene = twoSquares(material);
    scene::Texture texture;
    texture.width = texture.height = 2;
    texture.sampler.magLinear = texture.sampler.minLinear = false;
    texture.rgba.assign(16, 255);
    texture.rgba[7] = texture.rgba[11] = 0;  // the alpha of two of the four texels
    scene.textures.push_back(texture);
    const std::vector<TestRay> rays = forwardRays(4000);
    for (const float vertexAlpha : {1.0f, 0.25f}) {
        scene.meshes[0].colors.assign(4, vec4(1, 1, 1, vertexAlpha));
        const std::vector<TestHit> hits = trace(scene, rays);
        for (size_t i = 0; i < rays.size(); ++i) {
            const vec3 p = rays[i].origin;
            if (std::min(std::abs(p.x), std::abs(p.y)) < 1e-4f) continue;
            const bool opaque = vertexAlpha == 1.0f && (p.x < 0.0f) == (p.y < 0.0f);
            ASSERT_NEAR(hits[i].t, opaque ? 1.0f : 2.0f, 1e-5f)
                << "at " << p.x << ' ' << p.y << " vertex alpha " << vertexAlpha;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Tracers, AlphaTest, testing::ValuesIn(allTracers), nameOfTracer);
// Only our tracer: whether a driver's is watertight is not tested here (lavapipe 25's is not).
INSTANTIATE_TEST_SUITE_P(Tracers, WatertightTest, testing::ValuesIn(computeTracers), nameOfTracer);

}  // namespace
}  // namespace limpid::test
