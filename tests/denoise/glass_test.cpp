// Tests the layers of what smooth glass shows: behind a pane, clear or a little clouded, they are those
// without the pane; in a glass ball, they follow what the ball shows, against rays refracted in double
// precision; a lamp that a block reflects is as free of noise as one that is seen directly.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "scene/builtin/builtin.h"
#include "scene/builtin/builtin_parts.h"
#include "tests/denoise/sequence_fixture.h"

namespace limpid::test {
namespace {

using glm::dvec2;

constexpr double wallZ = -4.0, index = 1.5;
enum Thing : uint32_t { wall, glass };

scene::Material glassMaterial(bool pane, float transmission) {
    scene::Material material = scene::glossy("glass", vec3(1.0f), 0.0f, 0.0f);
    material.transmission = transmission;
    material.thin = pane;
    return material;
}

/// A wall, and before it a pane, a ball of radius 1, or nothing.
scene::Scene wallBehind(std::optional<bool> pane, float transmission = 1.0f) {
    scene::Scene scene;
    scene.name = "glass";
    scene.materials = {scene::lambertian("wall", {0.2f, 0.5f, 0.8f}),
                       glassMaterial(pane.value_or(true), transmission)};
    const auto z = static_cast<float>(wallZ);
    scene::MeshBuilder builder("wall");
    builder.quad({-40, -40, z}, {40, -40, z}, {40, 40, z}, {-40, 40, z});
    scene::addMesh(scene, builder.take(), wall);
    if (pane) {
        scene::MeshBuilder shape("glass", !*pane);
        if (*pane)
            shape.quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
        else
            shape.sphere(vec3(0.0f), 1.0f, 512, 256);
        scene::addMesh(scene, shape.take(), glass);
    }
    scene::addCamera(scene, {0.6f, 0.4f, 6.0f}, {0.0f, 0.0f, 0.0f}, 0.5f);
    return scene;
}

dvec3 refracted(const dvec3& direction, const dvec3& normal, double eta) {
    const double cosine = -glm::dot(direction, normal);
    const double behind = std::sqrt(1.0 - (1.0 - cosine * cosine) / (eta * eta));
    return direction / eta + normal * (cosine / eta - behind);
}

/// Where the wall is seen through the ball at a pixel position; nothing for rays that miss its middle.
std::optional<dvec2> seenOnTheWall(const CameraParams& camera, gpu::Extent extent, const dvec2& pixel) {
    const dvec2 at = pixel / dvec2(extent.width, extent.height) * dvec2(2, -2) + dvec2(-1, 1);
    const dvec3 direction =
        glm::normalize(dvec3(camera.forward) + at.x * dvec3(camera.right) + at.y * dvec3(camera.up));
    const dvec3 eye(camera.origin);
    const double middle = -glm::dot(eye, direction);
    const double off2 = glm::dot(eye, eye) - middle * middle;
    if (off2 > 0.36) return {};
    const dvec3 in = eye + direction * (middle - std::sqrt(1.0 - off2));
    const dvec3 inside = refracted(direction, in, index);
    const dvec3 out = in - 2.0 * glm::dot(in, inside) * inside;
    const dvec3 leaving = refracted(inside, -out, 1.0 / index);
    const dvec3 point = out + leaving * ((wallZ - out.z) / leaving.z);
    return dvec2(point);
}

/// The pixel position at which `camera` sees that point of the wall through the ball: Newton's method.
std::optional<dvec2> pixelOf(const CameraParams& camera, gpu::Extent extent, dvec2 pixel,
                             const dvec2& onWall) {
    for (int step = 0; step < 20; ++step) {
        const auto here = seenOnTheWall(camera, extent, pixel);
        const auto right = seenOnTheWall(camera, extent, pixel + dvec2(1e-4, 0));
        const auto below = seenOnTheWall(camera, extent, pixel + dvec2(0, 1e-4));
        if (!here || !right || !below) return {};
        const glm::dmat2 slope((*right - *here) * 1e4, (*below - *here) * 1e4);
        pixel += glm::inverse(slope) * (onWall - *here);
    }
    return pixel;
}

class GlassLayersTest : public SequenceTest {
  protected:
    static constexpr gpu::Extent extent{160, 90};

    RenderedLayers layersOf(scene::Scene scene, bool through) {
        load(std::move(scene), {.framesPerSecond = 24.0}, "shake");
        moment_ = sequence_->moment(5, extent);
        RenderSettings settings = centred(extent.width, extent.height, 1);
        settings.layers = true;
        settings.pathtrace.throughGlass = through;
        FrameRenderer still(device(), *gpuScene_, settings, 1);
        still.render(moment_);
        return still.download();
    }

    /// Of the pane that transmits this share, from those without it.
    void expectLayersWithoutPane(float transmission);

    Moment moment_;
};

void GlassLayersTest::expectLayersWithoutPane(float transmission) {
    SCOPED_TRACE(fmt::format("transmission {}", transmission));
    const RenderedLayers with = layersOf(wallBehind(true, transmission), true);
    const RenderedLayers own = layersOf(wallBehind(true, transmission), false);
    const RenderedLayers without = layersOf(wallBehind({}), true);
    size_t seen = 0;
    for (size_t p = 0; p < size_t{extent.width} * extent.height; ++p) {
        seen += own.ids[2 * p] == glass;
        ASSERT_EQ(with.ids[2 * p], wall);
        EXPECT_NEAR(with.depth[4 * p], without.depth[4 * p], 1e-3f);
        for (size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(with.normal[4 * p + c], without.normal[4 * p + c], 1e-4f);
            const float behind = without.albedo[4 * p + c] * (own.ids[2 * p] == glass ? transmission : 1.0f);
            EXPECT_LE(with.albedo[4 * p + c], behind + 1e-5f);
            EXPECT_GE(with.albedo[4 * p + c], behind * 0.8f);
        }
        ASSERT_EQ(with.motion[4 * p + 3], 1.0f);
        EXPECT_NEAR(with.motion[4 * p], without.motion[4 * p], 0.01f);
        EXPECT_NEAR(with.motion[4 * p + 1], without.motion[4 * p + 1], 0.01f);
        if (HasFailure()) FAIL() << "pixel " << p % extent.width << ", " << p / extent.width;
    }
    EXPECT_GT(seen, 1000u) << "proves little";
}

TEST_F(GlassLayersTest, BehindAPaneAreThoseWithoutThePane) {
    for (const float transmission : {1.0f, 0.8f}) expectLayersWithoutPane(transmission);
}

TEST_F(GlassLayersTest, InABallMoveAsWhatTheBallShows) {
    const scene::Scene scene = wallBehind(false);
    const RenderedLayers through = layersOf(scene, true), own = layersOf(scene, false);
    double error = 0.0, ofTheSurface = 0.0;
    size_t count = 0;
    for (size_t p = 0; p < size_t{extent.width} * extent.height; ++p) {
        const dvec2 pixel(static_cast<double>(p % extent.width) + 0.5,
                          static_cast<double>(p / extent.width) + 0.5);
        const auto onWall = seenOnTheWall(moment_.camera, extent, pixel);
        if (own.ids[2 * p] != glass || !onWall) continue;
        EXPECT_EQ(through.ids[2 * p], wall);
        const auto before = pixelOf(*moment_.previousCamera, extent, pixel, *onWall);
        if (!before) continue;
        ASSERT_EQ(through.motion[4 * p + 3], 1.0f);
        const auto errorOf = [&](const RenderedLayers& layers) {
            return glm::length(pixel + dvec2(layers.motion[4 * p], layers.motion[4 * p + 1]) - *before);
        };
        error += errorOf(through);
        ofTheSurface += errorOf(own);
        ++count;
    }
    ASSERT_GT(count, 500u) << "proves little";
    const auto n = static_cast<double>(count);
    fmt::print("in a glass ball, pixels: motion is wrong by {:.3f}, the surface's by {:.3f}\n", error / n,
               ofTheSurface / n);
    EXPECT_LT(error, 0.35 * ofTheSurface);
}

/// A wall, before it a block of glass, and behind the camera a lamp that fills the block's reflection.
scene::Scene blockBeforeALamp(float radiance) {
    scene::Scene scene = wallBehind({});
    scene::MeshBuilder block("block");
    block.box({-1.2f, -1.0f, -0.4f}, {1.2f, 1.0f, 0.0f});
    scene::addMesh(scene, block.take(), glass);
    scene.materials[glass].thin = false;
    scene.materials.push_back(scene::emitter("lamp", vec3(0.5f), vec3(radiance)));
    scene::MeshBuilder lamp("lamp");
    lamp.quad({40, -40, 9}, {-40, -40, 9}, {-40, 40, 9}, {40, 40, 9});
    scene::addMesh(scene, lamp.take(), 2);
    return scene;
}

/// Of unpolarised light that enters glass, in double precision.
double fresnel(double cosine) {
    const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const double p = (index * cosine - inside) / (index * cosine + inside);
    const double s = (cosine - index * inside) / (cosine + index * inside);
    return 0.5 * (p * p + s * s);
}

TEST_F(GlassLayersTest, ALampInGlassIsEmissionWithoutNoise) {
    constexpr float radiance = 3.0f;
    const RenderedLayers layers = layersOf(blockBeforeALamp(radiance), true);
    const dvec3 eye(moment_.camera.origin);
    size_t count = 0;
    for (size_t p = 0; p < size_t{extent.width} * extent.height; ++p) {
        const dvec2 at = dvec2(2.0, -2.0) * dvec2((p % extent.width + 0.5) / extent.width,
                                                  (p / extent.width + 0.5) / extent.height) +
                         dvec2(-1.0, 1.0);
        const dvec3 direction =
            glm::normalize(dvec3(moment_.camera.forward) + at.x * dvec3(moment_.camera.right) +
                           at.y * dvec3(moment_.camera.up));
        const dvec3 on = eye - direction * (eye.z / direction.z);
        if (std::abs(on.x) > 1.19 || std::abs(on.y) > 0.99) continue;
        for (size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(double{layers.emission[4 * p + c]}, double{radiance} * fresnel(-direction.z), 1e-3);
        ++count;
    }
    EXPECT_GT(count, 1000u) << "proves little";
}

/// One lobe at each surface, or all of those of the first one and one of the rest.
TEST_F(GlassLayersTest, TheMeanIsThatOfPathsThroughOneLobeAtATime) {
    load(blockBeforeALamp(3.0f), {.framesPerSecond = 24.0}, "shake");
    double mean[2] = {};
    for (const bool through : {false, true}) {
        RenderSettings settings = centred(64, 36, 8);
        settings.layers = true;
        settings.samplesPerLaunch = 4;
        settings.pathtrace.throughGlass = through;
        FrameRenderer renderer(device(), *gpuScene_, settings, 256);
        renderer.render(sequence_->moment(5, settings.extent));
        const RenderedLayers layers = renderer.download();
        for (const auto* light : {&layers.diffuse, &layers.specular, &layers.emission}) {
            for (size_t i = 0; i < light->size(); ++i)
                mean[through] += i % 4 == 3 ? 0.0 : double{(*light)[i]} / double{3 * 64 * 36};
        }
    }
    fmt::print("mean by one lobe {:.5f}, by all {:.5f}\n", mean[0], mean[1]);
    EXPECT_NEAR(mean[1] / mean[0], 1.0, 0.003);
}

}  // namespace
}  // namespace limpid::test
