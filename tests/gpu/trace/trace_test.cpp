// Compares traversal with a tracer that uses no tree.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/builtin.h"
#include "scene/builtin/mesh_builder.h"
#include "tests/gpu/trace/trace_fixture.h"

namespace limpid::test {
namespace {

class TraceReferenceTest : public TraceTest {
  protected:
    /// Returns rays from inside and around the scene in all directions, including axis-parallel and short
    /// ones.
    static std::vector<TestRay> someRays(const BruteForce& brute, uint32_t count, uint32_t seed) {
        std::mt19937 random(seed);
        const vec3 center = 0.5f * (brute.lower() + brute.upper()),
                   half = 0.5f * (brute.upper() - brute.lower());
        std::vector<TestRay> rays;
        for (uint32_t i = 0; i < count; ++i) {
            const vec3 origin = center + randomPoint(random, -1.3f * half, 1.3f * half);
            vec3 direction = randomDirection(random);
            // Half of the rays aim at the scene, or few would hit it.
            if (i % 2 == 0) direction = glm::normalize(center + randomPoint(random, -half, half) - origin);
            if (i % 16 == 1) {
                const auto axis = static_cast<int>(random() % 3);
                direction = vec3(0.0f);
                direction[axis] = random() % 2 == 0 ? 1.0f : -1.0f;
            }
            if (i % 16 == 3) direction = glm::normalize(vec3(direction.x, 0.0f, direction.z));
            rays.push_back({origin, direction, i % 4 == 2 ? 0.5f * glm::length(half) : 1e30f});
        }
        return rays;
    }

    void compare(const scene::Scene& scene, uint32_t rayCount, uint32_t seed) {
        const BruteForce brute(scene);
        const std::vector<TestRay> rays = someRays(brute, rayCount, seed);
        const std::vector<TestHit> hits = trace(scene, rays);
        uint32_t found = 0, doubtful = 0, wrong = 0;
        double worst = 0.0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const BruteHit expected = brute.closest(rays[i]);
            found += expected.t >= 0.0;
            doubtful += expected.doubtful;
            if (expected.doubtful) continue;
            const TestHit& hit = hits[i];
            const bool same = (hit.t >= 0.0f) == (expected.t >= 0.0) &&
                              (hit.any != 0) == (expected.t >= 0.0) && hit.instance == expected.instance &&
                              hit.primitive == expected.primitive;
            // The error of subtracting coordinates is added to the relative error.
            const double rounding = 1e-6 * double{glm::length(rays[i].origin)};
            const double error =
                expected.t >= 0.0
                    ? std::max(0.0, std::abs(double{hit.t} - expected.t) - rounding) / expected.t
                    : 0.0;
            if (same && error < 1e-4) {
                worst = std::max(worst, error);
                continue;
            }
            if (++wrong > 3) continue;
            const TestRay& r = rays[i];
            ADD_FAILURE() << fmt::format(
                "{} seed {} ray {}: origin {} {} {} direction {} {} {} tMax {}: t {} instance {} primitive "
                "{} any {}; "
                "expected t {} instance {} primitive {}",
                scene.name, seed, i, r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y,
                r.direction.z, r.tMax, hit.t, hit.instance, hit.primitive, hit.any, expected.t,
                expected.instance, expected.primitive);
        }
        fmt::print("{}: {} triangles, {} rays, {} hits, {} doubtful, {} wrong, t within {:.1g}\n", scene.name,
                   brute.triangleCount(), rays.size(), found, doubtful, wrong, worst);
        EXPECT_EQ(wrong, 0u);
        // Rays parallel to an axis lie in diagonals and edges of the built-in rooms.
        EXPECT_LE(doubtful, rayCount / 50) << "the test would prove little";
        EXPECT_GT(found, rayCount / 40);
    }

    static scene::Scene soupScene(float size, const vec3& offset, uint32_t count, uint32_t seed) {
        scene::Scene scene = plainScene();
        scene.name = fmt::format("soup of size {} at {} {} {}", size, offset.x, offset.y, offset.z);
        scene.meshes.push_back(triangleSoup(count, size, seed));
        for (vec3& p : scene.meshes[0].positions) p += offset;
        addInstance(scene, 0);
        return scene;
    }
};

TEST_P(TraceReferenceTest, TriangleSoups) {
    for (const uint32_t count : {1u, 3u, 20u, 2000u}) {
        const scene::Scene scene = soupScene(1.0f, vec3(0.0f), count, count);
        if (count >= 20) {
            compare(scene, 4096, 11);
        } else {
            // With few triangles, rays hit by chance only, so only check agreement.
            const BruteForce brute(scene);
            const std::vector<TestRay> rays = someRays(brute, 2048, 5);
            const std::vector<TestHit> hits = trace(scene, rays);
            for (size_t i = 0; i < rays.size(); ++i) {
                const BruteHit expected = brute.closest(rays[i]);
                if (expected.doubtful) continue;
                ASSERT_EQ(hits[i].t >= 0.0f, expected.t >= 0.0) << count << " triangles, ray " << i;
            }
        }
    }
}

TEST_P(TraceReferenceTest, TinyScale) {
    compare(soupScene(1e-3f, vec3(0.0f), 2000, 3), 4096, 12);
}

TEST_P(TraceReferenceTest, FarFromTheOrigin) {
    compare(soupScene(20.0f, {10000.0f, -3000.0f, 5000.0f}, 2000, 4), 4096, 13);
}

/// From a distance at which a node is smaller than the rounding of coordinates, missing children must not be
/// followed for ever.
TEST_P(TraceReferenceTest, TinyThingsFarAwayAndNothingAtAll) {
    scene::Scene scene = soupScene(1e-3f, vec3(0.0f), 5, 3);
    std::mt19937 random(4);
    std::vector<TestRay> rays;
    for (int i = 0; i < 512; ++i) {
        const vec3 origin = 1e5f * randomDirection(random);
        rays.push_back({origin, glm::normalize(-origin)});
    }
    for (const TestHit& hit : trace(scene, rays)) {
        const bool plausible = hit.t < 0.0f || std::abs(hit.t - 1e5f) < 1.0f;
        EXPECT_TRUE(plausible) << hit.t;
    }
    scene.instances.clear();
    rays.push_back({vec3(0.0f), vec3(0, 0, 1)});
    for (const TestHit& hit : trace(scene, rays)) EXPECT_LT(hit.t, 0.0f);
}

TEST_P(TraceReferenceTest, BuiltinScenes) {
    for (const char* name : {"cornell", "cornell-spheres", "furnace"})
        compare(scene::builtinScene(name), 2048, 21);
    compare(scene::builtinScene("heavy"), 512, 22);
}

/// Copies of one mesh, enough for a two-level tree, transformed in all ways, beside a mesh that stays in the
/// static tree.
TEST_P(TraceReferenceTest, TwoLevels) {
    scene::Scene scene = plainScene();
    scene.name = "instances";
    scene.meshes.push_back(triangleSoup(700, 1.0f, 5));
    scene.meshes.push_back(triangleSoup(300, 4.0f, 6));
    std::mt19937 random(9);
    for (int i = 0; i < 12; ++i) {
        mat4 m = glm::translate(mat4(1.0f), randomPoint(random, vec3(-4), vec3(4)));
        m = glm::rotate(m, 0.7f * static_cast<float>(i), randomDirection(random));
        m = glm::scale(m, vec3(0.3f + 0.1f * static_cast<float>(i), i % 3 == 0 ? -0.8f : 0.9f, 0.6f));
        addInstance(scene, 0, m);
    }
    addInstance(scene, 1);
    compare(scene, 4096, 31);
    EXPECT_TRUE(twoLevel());
    // And without a static tree.
    scene.instances.pop_back();
    scene.name = "instances only";
    compare(scene, 2048, 32);
}

INSTANTIATE_TEST_SUITE_P(Tracers, TraceReferenceTest, testing::ValuesIn(allTracers), nameOfTracer);

}  // namespace
}  // namespace limpid::test
