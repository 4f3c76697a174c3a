// Tests that cameras are found again in the layers that they see.
#include "shot/camera/camera_solve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "shot/camera/camera_track.h"

namespace limpid::shot {
namespace {

using image::Image;

constexpr uint32_t width = 64, height = 36;

ShotCamera exampleCamera() {
    ShotCamera camera;
    camera.eye = {3, -7, 2};
    camera.forward = glm::normalize(vec3(-0.3f, 0.9f, -0.2f));
    camera.up = {0.1f, 0.0f, 1.0f};
    camera.verticalFov = glm::radians(37.0f);
    return camera;
}

/// Random depths between 2 and 9, and what else a file has of them.
struct View {
    Image depth{width, height, 1}, position{width, height, 3}, distance{width, height, 1};
};
View viewOf(const CameraParams& camera, float near, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> depths(2.0f, 9.0f);
    View view;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const float sx = 2.0f * (static_cast<float>(x) + 0.5f) / width - 1.0f;
            const float sy = 1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / height;
            const vec3 ray = camera.forward + sx * camera.right + sy * camera.up;
            const float z = depths(random);
            view.depth.at(x, y, 0) = z;
            view.distance.at(x, y, 0) = (z - near) * glm::length(ray);
            for (uint32_t c = 0; c < 3; ++c)
                view.position.at(x, y, c) = camera.origin[static_cast<int>(c)] + z * ray[static_cast<int>(c)];
        }
    return view;
}

void expectNear(const vec3& a, const vec3& b, float tolerance) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << ", expected " << b.x << " " << b.y << " " << b.z;
}

TEST(CameraSolve, PositionsAndDepthTellTheWholeCamera) {
    for (const vec2 shift : {vec2(0, 0), vec2(0.2f, -0.1f)}) {
        ShotCamera camera = exampleCamera();
        camera.shift = shift;
        const CameraParams params = camera.params(width, height);
        View view = viewOf(params, 0.0f, 1);
        // A fifth of the pixels is nonsense, as at edges; misses are marked.
        for (uint32_t x = 0; x < width; x += 5)
            for (uint32_t y = 0; y < height; ++y) view.position.at(x, y, 1) += 0.5f;
        view.depth.at(3, 3, 0) = 1e10f;
        const auto found = viewFromPositions(view.position, view.depth, 9e9f);
        ASSERT_TRUE(found);
        expectNear(found->eye, params.origin, 1e-3f);
        expectNear(found->forward, params.forward, 1e-4f);
        expectNear(found->right, params.right, 1e-4f);
        expectNear(found->up, params.up, 1e-4f);
    }
}

TEST(CameraSolve, NoCameraFollowsFromAPlaneOrFromNothing) {
    View view = viewOf(exampleCamera().params(width, height), 0.0f, 1);
    Image flat = view.position;
    for (size_t i = 2; i < flat.pixels.size(); i += 3) flat.pixels[i] = 1.0f;
    EXPECT_FALSE(viewFromPositions(flat, view.depth, 9e9f));
    for (float& z : view.depth.pixels) z = 1e10f;
    EXPECT_FALSE(viewFromPositions(view.position, view.depth, 9e9f));
}

TEST(CameraSolve, WidePixelsMakeTheViewLower) {
    const CameraParams camera = exampleCamera().params(width, height, 2.0f);
    const View view = viewOf(camera, 0.1f, 2);
    const auto tangent = horizontalTangent(view.distance, view.depth, 9e9f, 2.0f);
    ASSERT_TRUE(tangent);
    EXPECT_NEAR(*tangent / glm::length(camera.right), 1.0f, 0.005f);
}

TEST(CameraSolve, DistancesFromTheNearPlaneTellTheAngle) {
    for (const float degrees : {8.0f, 37.0f, 90.0f})
        for (const float near : {0.0f, 0.1f}) {
            ShotCamera camera = exampleCamera();
            camera.verticalFov = glm::radians(degrees);
            View view = viewOf(camera.params(width, height), near, 2);
            // Mirrors and glass: the distance goes on behind them.
            for (uint32_t x = 0; x < width / 4; ++x)
                for (uint32_t y = 0; y < height; ++y) view.distance.at(x, y, 0) *= 1.7f;
            const auto tangent = horizontalTangent(view.distance, view.depth, 9e9f);
            ASSERT_TRUE(tangent) << degrees;
            const float expected = std::tan(camera.verticalFov / 2.0f) * width / height;
            EXPECT_NEAR(*tangent / expected, 1.0f, 0.005f) << degrees << " degrees, near plane at " << near;
        }
    Image noise(width, height, 1);
    std::mt19937 random(3);
    for (float& v : noise.pixels) v = std::uniform_real_distribution<float>(1.0f, 9.0f)(random);
    EXPECT_FALSE(
        horizontalTangent(noise, viewOf(exampleCamera().params(width, height), 0.0f, 4).depth, 9e9f));
}

TEST(CameraSolve, NormalsInTwoSpacesTellTheOrientation) {
    const mat3 turn(glm::angleAxis(1.1f, glm::normalize(vec3(1, 2, -0.5f))));
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    Image camera(width, height, 3), world(width, height, 3);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const vec3 n = glm::normalize(vec3(normal(random), normal(random), 2.0f + normal(random)));
            // A quarter shows something else, and a mean of normals is no normal.
            const vec3 w = x % 4 == 0 ? glm::normalize(vec3(1, normal(random), 0)) : turn * n;
            const float length = x % 7 == 1 ? 0.6f : 1.0f;
            for (int c = 0; c < 3; ++c) {
                camera.at(x, y, static_cast<uint32_t>(c)) = n[c] * length;
                world.at(x, y, static_cast<uint32_t>(c)) = w[c];
            }
        }
    const auto found = rotationBetween(camera, world);
    ASSERT_TRUE(found);
    for (int c = 0; c < 3; ++c) expectNear((*found)[c], turn[c], 1e-4f);
    for (size_t i = 0; i < camera.pixels.size(); ++i)
        camera.pixels[i] = world.pixels[i] = i % 3 == 2 ? 1.0f : 0.0f;
    EXPECT_FALSE(rotationBetween(camera, world)) << "parallel normals leave a turn open";
}

TEST(CameraSolve, TheMovementThatMostPointsShareIsTheCameras) {
    const mat3 turn(glm::angleAxis(0.12f, glm::normalize(vec3(0.2f, 1, 0.1f))));
    const vec3 step(0.4f, -0.1f, 0.6f);
    std::mt19937 random(6);
    std::uniform_real_distribution<float> side(-0.5f, 0.5f), depth(2.0f, 12.0f), noise(-2e-4f, 2e-4f);
    std::vector<TrackedPoint> points;
    for (int i = 0; i < 2000; ++i) {
        const vec3 point = vec3(side(random), side(random), -1.0f) * depth(random);
        vec3 before = turn * point + step;
        if (i % 3 == 0) before += vec3(0.5f, 0.3f, 0);  // moves by itself
        points.push_back({point, vec2(before) / -before.z + vec2(noise(random), noise(random))});
    }
    const auto move = cameraMove(points, 1e-3f);
    ASSERT_TRUE(move);
    for (int c = 0; c < 3; ++c) expectNear(move->rotation[c], turn[c], 1e-3f);
    expectNear(move->translation, step, 5e-3f);
    EXPECT_NEAR(move->inliers, 2.0f / 3.0f, 0.02f);
    EXPECT_FALSE(cameraMove(std::span(points).first(20), 1e-3f));
    for (TrackedPoint& point : points) point.before = {side(random), side(random)};
    EXPECT_FALSE(cameraMove(points, 1e-3f)) << "random motion is no camera's";
}

}  // namespace
}  // namespace limpid::shot
