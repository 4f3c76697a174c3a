#include "studio/camera/fly_camera.h"

#include <gmock/gmock.h>

#include <cmath>

#include "scene/model/camera.h"

namespace limpid::studio {
namespace {

FlyCamera facingMinusZ() {
    return {scene::lookAt({1, 2, 3}, {1, 2, -7}, {0, 1, 0}, 0.8f), 10.0f};
}

void expectNear(const vec3& a, const vec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-4f)
        << a.x << " " << a.y << " " << a.z << ", not " << b.x << " " << b.y << " " << b.z;
}

TEST(FlyCamera, StandsWhereItStarted) {
    const scene::Camera start = scene::lookAt({4, -1, 2}, {0, 3, 5}, {0, 1, 0}, 0.6f);
    const scene::Camera camera = FlyCamera(start, 3.0f).camera();
    for (int column = 0; column < 4; ++column)
        expectNear(vec3(camera.toWorld[column]), vec3(start.toWorld[column]));
    EXPECT_EQ(camera.verticalFov, 0.6f);
}

TEST(FlyCamera, KeepsTheRollThatItStartedWith) {
    const scene::Camera start = scene::lookAt({4, -1, 2}, {0, 3, 5}, {1, 1, 0}, 0.6f);
    FlyCamera camera(start, 3.0f);
    for (int column = 0; column < 4; ++column)
        expectNear(vec3(camera.camera().toWorld[column]), vec3(start.toWorld[column]));
    const vec3 up = camera.up();
    camera.orbit(0.3f, 0.1f);
    expectNear(camera.up(), up);
}

TEST(FlyCamera, IsPlacedByNumbers) {
    FlyCamera camera = facingMinusZ();
    ASSERT_TRUE(camera.place({1, 2, 3}, {4, 5, -6}, {0, 0, 2}));
    expectNear(camera.eye(), {1, 2, 3});
    expectNear(camera.target(), {4, 5, -6});
    expectNear(camera.up(), {0, 0, 1});
    const scene::Camera expected = scene::lookAt({1, 2, 3}, {4, 5, -6}, {0, 0, 1}, 0.8f);
    for (int column = 0; column < 4; ++column)
        expectNear(vec3(camera.camera().toWorld[column]), vec3(expected.toWorld[column]));
    EXPECT_FALSE(camera.place({1, 2, 3}, {1, 2, 3}, {0, 1, 0}));
    EXPECT_FALSE(camera.place({1, 2, 3}, {1, 9, 3}, {0, 1, 0}));
    expectNear(camera.target(), {4, 5, -6});
}

TEST(FlyCamera, OrbitsAroundItsTarget) {
    FlyCamera camera = facingMinusZ();
    camera.orbit(1.57079633f, 0.0f);  // dragging to the right moves the eye to the left
    expectNear(camera.target(), {1, 2, -7});
    expectNear(camera.eye(), {-9, 2, -7});
    camera.orbit(0.0f, -10.0f);  // stops short of the pole
    expectNear(camera.target(), {1, 2, -7});
    EXPECT_LT(std::abs(camera.forward().y), 1.0f);
    EXPECT_GT(std::abs(camera.forward().y), 0.999f);
}

TEST(FlyCamera, LooksAroundWhereItStands) {
    FlyCamera camera = facingMinusZ();
    camera.look(1.57079633f, 0.0f);
    expectNear(camera.eye(), {1, 2, 3});
    expectNear(camera.forward(), {1, 0, 0});
    camera.look(0.0f, 0.785398163f);
    expectNear(camera.forward(), {std::sqrt(0.5f), std::sqrt(0.5f), 0});
}

TEST(FlyCamera, PansByPicturesAndMovesByUnits) {
    FlyCamera camera = facingMinusZ();
    const float height = 20.0f * std::tan(0.4f);
    camera.pan(0.5f, -1.0f);  // the scene follows the mouse
    expectNear(camera.eye(), {1 - 0.5f * height, 2 + height, 3});
    camera.move({1, 2, 3});
    expectNear(camera.eye(), {2 - 0.5f * height, 4 + height, 0});
}

TEST(FlyCamera, ZoomsTowardsItsTarget) {
    FlyCamera camera = facingMinusZ();
    camera.zoom(0.5f);
    expectNear(camera.target(), {1, 2, -7});
    expectNear(camera.eye(), {1, 2, -2});
    camera.zoom(0.0f);  // never reaches the target
    EXPECT_GT(camera.distance(), 0.0f);
}

TEST(FlyCamera, FocusTurnsToThePointAndThenAroundIt) {
    FlyCamera camera(scene::lookAt(vec3(1, 2, 3), vec3(0, 2, 3), vec3(0, 1, 0), 0.6f), 5.0f);
    const vec3 point(4, 1, -2);
    camera.focus(point);
    EXPECT_EQ(camera.eye(), vec3(1, 2, 3));
    EXPECT_LT(glm::distance(camera.target(), point), 1e-5f);
    camera.orbit(0.7f, 0.1f);
    EXPECT_LT(glm::distance(camera.target(), point), 1e-5f);
}

}  // namespace
}  // namespace limpid::studio
