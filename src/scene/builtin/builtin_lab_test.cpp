// Tests the lab's scenes: small, lit, closed; they move at the documented times, and the mirror is at the
// documented position.
#include "scene/builtin/builtin_lab.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene/builtin/builtin.h"
#include "scene/builtin/mesh_builder.h"
#include "scene/framing/camera_path.h"
#include "scene/framing/framing.h"
#include "scene/model/camera.h"
#include "scene/prepare/prepare.h"

namespace limpid::scene::test {
namespace {

std::vector<std::string> labNames() {
    std::vector<std::string> names;
    for (const BuiltinInfo& info : builtinScenes()) {
        if (info.name.starts_with("lab-")) names.push_back(info.name);
    }
    return names;
}

const Instance& instanceNamed(const Scene& scene, const std::string& name) {
    const auto found = std::find_if(scene.instances.begin(), scene.instances.end(),
                                    [&](const Instance& instance) { return instance.name == name; });
    if (found == scene.instances.end()) throw std::runtime_error("no instance " + name);
    return *found;
}

/// Returns the position of the instance's origin in the scene's only clip.
vec3 positionAt(const Scene& scene, const std::string& name, double time) {
    const RigPose pose = evaluate(scene.rig, &scene.rig.clips.at(0), time);
    return vec3(pose.toWorld.at(static_cast<size_t>(instanceNamed(scene, name).node))[3]);
}

struct Hit {
    float distance = std::numeric_limits<float>::infinity();
    std::string instance;
    bool front = false;
};

/// Tests every triangle with Moeller and Trumbore's algorithm.
Hit nearest(const Scene& scene, const vec3& origin, const vec3& direction) {
    Hit hit;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const auto place = [&](size_t i) {
            return vec3(instance.transform * vec4(mesh.positions[mesh.indices[i]], 1.0f));
        };
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const vec3 a = place(i), e1 = place(i + 1) - a, e2 = place(i + 2) - a;
            const vec3 p = glm::cross(direction, e2), q = glm::cross(origin - a, e1);
            const float determinant = glm::dot(e1, p);
            if (std::abs(determinant) < 1e-12f) continue;
            const float u = glm::dot(origin - a, p) / determinant, v = glm::dot(direction, q) / determinant;
            const float t = glm::dot(e2, q) / determinant;
            if (u < 0.0f || v < 0.0f || u + v > 1.0f || t < 1e-4f || t >= hit.distance) continue;
            hit = {t, instance.name, determinant > 0.0f};
        }
    }
    return hit;
}

vec3 eyeOf(const Camera& camera) {
    return vec3(camera.toWorld[3]);
}

/// Projects a point to -1 to 1 on a picture of 16:9, y up; returns nothing if it is behind the camera.
std::optional<vec2> onScreen(const Camera& camera, const vec3& point) {
    const vec3 p = vec3(glm::inverse(camera.toWorld) * vec4(point, 1.0f));
    if (p.z >= 0.0f) return std::nullopt;
    const float slope = std::tan(0.5f * camera.verticalFov);
    return vec2(p.x / (slope * 16.0f / 9.0f), p.y / slope) / -p.z;
}

/// Seen from the front, every face has u to the right and v down; on walls, v points against +Y.
TEST(Wallpaper, IsUprightAndNeverMirrored) {
    for (const bool inside : {false, true}) {
        MeshBuilder builder("box");
        builder.box({-1, -2, -3}, {2, 3, 1}, 0, inside);
        Mesh mesh = builder.take();
        addWallpaperCoordinates(mesh);
        ASSERT_EQ(mesh.triangleCount(), 12u);
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const uint32_t* index = &mesh.indices[i];
            const vec3 e1 = mesh.positions[index[1]] - mesh.positions[index[0]],
                       e2 = mesh.positions[index[2]] - mesh.positions[index[0]];
            const vec2 t1 = mesh.uv0[index[1]] - mesh.uv0[index[0]],
                       t2 = mesh.uv0[index[2]] - mesh.uv0[index[0]];
            const float determinant = t1.x * t2.y - t1.y * t2.x;
            const vec3 alongU = (t2.y * e1 - t1.y * e2) / determinant,
                       alongV = (t1.x * e2 - t2.x * e1) / determinant;
            const vec3 normal = glm::normalize(glm::cross(e1, e2));
            EXPECT_LT(glm::distance(glm::cross(alongU, -alongV), normal), 1e-5f) << "in metres";
            if (std::abs(normal.y) < 0.5f) {
                EXPECT_LT(glm::distance(alongV, vec3(0, -1, 0)), 1e-5f);
            }
        }
    }
}

TEST(LabScenes, AreSmallLitAndUsable) {
    EXPECT_EQ(labNames().size(), 7u);
    for (const std::string& name : labNames()) {
        SCOPED_TRACE(name);
        Scene scene = builtinScene(name);
        EXPECT_EQ(scene.name, name);
        EXPECT_GT(scene.triangleCount(), 20u);
        EXPECT_LT(scene.triangleCount(), name == "lab-glass" ? 10000u : 1000u);
        ASSERT_EQ(scene.cameras.size(), 1u);
        EXPECT_TRUE(std::any_of(scene.materials.begin(), scene.materials.end(),
                                [](const Material& material) { return material.emission != vec3(0.0f); }));
        prepare(scene);
        EXPECT_TRUE(scene.environment.empty()) << "no sky had to be added";
        for (const Clip& clip : scene.rig.clips) EXPECT_FLOAT_EQ(clip.duration(), 4.0f);
    }
}

/// Every camera ray hits something, and its front face.
TEST(LabScenes, AreClosed) {
    for (const std::string& name : labNames()) {
        const Scene scene = builtinScene(name);
        for (int i = 0; i < 500; ++i) {
            const float z = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / 500.0f;
            const float phi = 2.399963f * static_cast<float>(i), r = std::sqrt(1.0f - z * z);
            const Hit hit =
                nearest(scene, eyeOf(scene.cameras[0]), {r * std::cos(phi), r * std::sin(phi), z});
            ASSERT_TRUE(std::isfinite(hit.distance)) << name;
            ASSERT_TRUE(hit.front) << name << ", " << hit.instance;
        }
    }
}

TEST(LabScenes, TheLightSlidesForASecondAndStays) {
    const Scene scene = builtinScene("lab-light");
    const vec3 start = positionAt(scene, "key", 0.0), end = positionAt(scene, "key", labChangeTime);
    EXPECT_GT(glm::distance(start, end), 2.0f);
    EXPECT_LT(glm::distance(positionAt(scene, "key", 0.25), glm::mix(start, end, 0.25f)), 1e-5f);
    for (const double time : {1.01, 2.0, 4.0}) EXPECT_EQ(positionAt(scene, "key", time), end) << time;
    EXPECT_EQ(vec3(instanceNamed(scene, "key").transform[3]), start);
}

TEST(LabScenes, OneOfTwoLightsGoesOutAtOnce) {
    const Scene scene = builtinScene("lab-switch");
    const vec3 on = positionAt(scene, "key", 0.0), out = positionAt(scene, "key", labChangeTime);
    for (const double time : {0.5, 0.999}) EXPECT_EQ(positionAt(scene, "key", time), on) << time;
    for (const double time : {1.001, 4.0}) EXPECT_EQ(positionAt(scene, "key", time), out) << time;
    const vec3 floor(0.0f, 0.05f, 1.0f);
    const auto seen = [&](const vec3& light) {
        return nearest(scene, floor, light - floor).distance > 0.999f;  // in units of the distance to the
                                                                        // light
    };
    EXPECT_TRUE(seen(on));
    EXPECT_FALSE(seen(out)) << "the ceiling is in between";
}

TEST(LabScenes, TheGrilleMovesFastAndStaysInTheRoom) {
    const Scene scene = builtinScene("lab-disocclusion");
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instanceNamed(scene, "grille").mesh)];
    for (int i = 0; i < 120; ++i) {
        const double time = i / 30.0;
        const vec3 now = positionAt(scene, "grille", time),
                   next = positionAt(scene, "grille", time + 1.0 / 30.0);
        EXPECT_NEAR(glm::distance(now, next) * 30.0f, 1.5f, 1e-3f) << time;
        for (const vec3& p : mesh.positions) ASSERT_LT(std::abs(now.x + p.x), 3.8f);
    }
}

TEST(LabScenes, TheHallHasItsLights) {
    const Scene scene = builtinScene("lab-lights");
    EXPECT_EQ(scene.meshes[static_cast<size_t>(instanceNamed(scene, "lights").mesh)].triangleCount(),
              2u * 220u);
}

TEST(LabMirror, ConstantsAreTheGeometry) {
    const Scene scene = builtinScene("lab-mirror");
    const MirrorLab& lab = mirrorLab();
    const Mesh& picture = scene.meshes[static_cast<size_t>(instanceNamed(scene, "picture").mesh)];
    // Uses the picture's own coordinates, to check that it is neither rotated nor flipped.
    const vec2 uv[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (size_t i = 0; i < 4; ++i) {
        const auto vertex = static_cast<size_t>(std::find(picture.uv0.begin(), picture.uv0.end(), uv[i]) -
                                                picture.uv0.begin());
        ASSERT_LT(vertex, picture.positions.size());
        EXPECT_EQ(picture.positions[vertex], lab.panelCorners[i]);
    }
    const Instance& mirror = instanceNamed(scene, "mirror");
    for (const vec3& p : scene.meshes[static_cast<size_t>(mirror.mesh)].positions) {
        EXPECT_NEAR(glm::dot(p - lab.mirrorPoint, lab.mirrorNormal), 0.0f, 1e-6f);
        EXPECT_EQ(p, glm::clamp(p, lab.mirrorLower, lab.mirrorUpper));
    }
    const Material& material = scene.materials[static_cast<size_t>(mirror.material)];
    EXPECT_EQ(material.roughness, 0.0f);
    EXPECT_EQ(material.metallic, 1.0f);
}

/// Checks that the ray to the mirror image hits the mirror, and its reflection the picture's front.
void expectSeenBothWays(const Scene& scene, const Camera& camera, const vec3& point) {
    const MirrorLab& lab = mirrorLab();
    const vec3 eye = eyeOf(camera), toImage = lab.reflected(point) - eye;
    const Hit direct = nearest(scene, eye, point - eye);
    EXPECT_EQ(direct.instance, "picture");
    EXPECT_TRUE(direct.front);
    const Hit mirror = nearest(scene, eye, toImage);
    ASSERT_EQ(mirror.instance, "mirror");
    EXPECT_TRUE(mirror.front);
    const Hit after =
        nearest(scene, eye + mirror.distance * toImage, glm::reflect(toImage, lab.mirrorNormal));
    EXPECT_EQ(after.instance, "picture");
    EXPECT_TRUE(after.front);
}

/// Returns the area of a quadrangle on the screen, with its corners in order.
float areaOf(const std::array<vec2, 4>& p) {
    float sum = 0.0f;
    for (size_t i = 0; i < 4; ++i) {
        const vec2 &a = p[i], &b = p[(i + 1) % 4];
        sum += a.x * b.y - a.y * b.x;
    }
    return 0.5f * std::abs(sum);
}

TEST(LabMirror, BothImagesStayInViewForFourSeconds) {
    Scene scene = builtinScene("lab-mirror");
    prepare(scene);
    const MirrorLab& lab = mirrorLab();
    for (const char* name : {"orbit", "dolly"}) {
        const CameraPath path = builtinCameraPath(name, scene, scene.cameras[0], 4.0);
        for (int i = 0; i <= 40; ++i) {
            SCOPED_TRACE(std::string(name) + " at " + std::to_string(0.1 * i) + " s");
            const Camera camera = path.at(0.1 * i);
            std::array<vec2, 4> direct{}, mirrored{};
            for (size_t k = 0; k < 4; ++k) {
                const auto a = onScreen(camera, lab.panelCorners[k]);
                const auto b = onScreen(camera, lab.reflected(lab.panelCorners[k]));
                ASSERT_TRUE(a && b);
                direct[k] = *a;
                mirrored[k] = *b;
                for (const vec2& p : {*a, *b}) EXPECT_LT(std::max(std::abs(p.x), std::abs(p.y)), 1.0f);
            }
            const float ratio = areaOf(mirrored) / areaOf(direct);
            EXPECT_GT(ratio, 0.6f);
            EXPECT_LT(ratio, 1.5f);
            // None of the points is on the diagonal between the picture's triangles.
            for (const float u : {0.02f, 0.45f, 0.97f}) {
                for (const float v : {0.02f, 0.45f, 0.97f}) {
                    expectSeenBothWays(scene, camera,
                                       lab.panelCorners[0] + u * (lab.panelCorners[1] - lab.panelCorners[0]) +
                                           v * (lab.panelCorners[3] - lab.panelCorners[0]));
                }
            }
        }
    }
}

TEST(LabMirror, CameraPathsGoAroundTheDesk) {
    const Scene scene = builtinScene("lab-mirror");
    const Camera& camera = scene.cameras[0];
    const vec3 eye = eyeOf(camera), forward = -vec3(camera.toWorld[2]);
    const vec3 target = eye + glm::dot(boundingSphere(scene).center - eye, forward) * forward;
    EXPECT_LT(glm::distance(target, vec3(0.0f, 0.6f, -0.5f)), 0.1f);
}

}  // namespace
}  // namespace limpid::scene::test
