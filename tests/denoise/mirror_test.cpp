// Tests the layers of a perfect mirror (primary surface replacement): in closed form with moving mirror,
// objects and camera; and that a picture is denoised as well through a mirror as when seen directly.
#include <fmt/format.h>

#include <cmath>

#include "image/metrics/metrics.h"
#include "image/tonemap.h"
#include "scene/builtin/builtin.h"
#include "scene/builtin/builtin_lab.h"
#include "scene/builtin/builtin_parts.h"
#include "tests/denoise/sequence_fixture.h"

namespace limpid::test {
namespace {

using glm::dvec2;

dvec3 directionAt(const CameraParams& camera, gpu::Extent extent, const dvec2& pixel) {
    const dvec2 at = pixel / dvec2(extent.width, extent.height) * dvec2(2, -2) + dvec2(-1, 1);
    return glm::normalize(dvec3(camera.forward) + at.x * dvec3(camera.right) + at.y * dvec3(camera.up));
}

dvec2 centreOf(size_t p, gpu::Extent extent) {
    return dvec2(static_cast<double>(p % extent.width), static_cast<double>(p / extent.width)) + 0.5;
}

/// Returns pixel position and distance; perspective only.
dvec3 seenAt(const CameraParams& camera, gpu::Extent extent, const dvec3& point) {
    const dvec3 v = point - dvec3(camera.origin), right(camera.right), up(camera.up);
    const double w = glm::dot(v, dvec3(camera.forward));
    const dvec2 ndc(glm::dot(v, right) / glm::dot(right, right) / w, -glm::dot(v, up) / glm::dot(up, up) / w);
    return {(ndc * 0.5 + 0.5) * dvec2(extent.width, extent.height), glm::length(v)};
}

dvec3 reflectedAt(const dvec3& v, const dvec3& normal) {
    return v - 2.0 * glm::dot(v, normal) * normal;
}

// An open scene: the mirror stands at z = 0 and moves towards +z; in front of it, a block moves along x over
// a floor.
const dvec3 mirrorVelocity(0, 0, 0.5), blockVelocity(1.2, 0, 0.3);
constexpr double framesPerSecond = 24.0;
const vec3 lampRadiance(3.0f, 2.0f, 1.0f);
enum Thing : uint32_t { mirror, block, ground, lamp };

void moveSteadily(scene::Scene& scene, scene::Clip& clip, uint32_t instance, const dvec3& velocity) {
    const vec3 end(velocity);
    clip.channels.push_back({scene::addNode(scene, instance),
                             scene::AnimatedValue::Translation,
                             scene::Interpolation::Linear,
                             3,
                             {0.0f, 1.0f},
                             {0.0f, 0.0f, 0.0f, end.x, end.y, end.z}});
}

scene::Scene mirrorScene(float roughness) {
    scene::Scene scene;
    scene.name = "mirror";
    scene.materials = {scene::glossy("mirror", {0.9f, 0.8f, 0.7f}, 1.0f, roughness),
                       scene::lambertian("block", {0.2f, 0.5f, 0.8f}),
                       scene::lambertian("ground", {0.6f, 0.4f, 0.3f}),
                       scene::emitter("lamp", vec3(0.0f), lampRadiance)};
    const auto add = [&](scene::MeshBuilder builder, int material) {
        scene::addMesh(scene, builder.take(), material);
    };
    add(scene::MeshBuilder("mirror").quad({-3, 0, 0}, {3, 0, 0}, {3, 3, 0}, {-3, 3, 0}), 0);
    add(scene::MeshBuilder("block").box({-1, 0, 1}, {0, 1, 2}), 1);
    add(scene::MeshBuilder("ground").quad({-9, 0, 9}, {9, 0, 9}, {9, 0, 1}, {-9, 0, 1}), 2);
    add(scene::MeshBuilder("lamp").quad({1, 1, 7}, {-1, 1, 7}, {-1, 3, 7}, {1, 3, 7}), 3);
    scene::addCamera(scene, {1.5f, 1.6f, 5.0f}, {-0.2f, 0.9f, 0.0f}, 0.9f);
    scene::Clip clip{"move", {}};
    moveSteadily(scene, clip, mirror, mirrorVelocity);
    moveSteadily(scene, clip, block, blockVelocity);
    scene::addClip(scene, std::move(clip));
    return scene;
}

class MirrorTest : public SequenceTest {
  protected:
    static constexpr gpu::Extent extent{160, 90};
    static constexpr uint64_t frame = 5;

    /// Renders the layers of `frame`, with the camera on the path `shake`.
    RenderedLayers layersOf(const scene::Scene& scene, bool throughMirrors) {
        load(scene, {.framesPerSecond = framesPerSecond}, "shake");
        moment_ = sequence_->moment(frame, extent);
        RenderSettings settings = centred(extent.width, extent.height, 4);
        settings.layers = true;
        settings.pathtrace.throughMirrors = throughMirrors;
        FrameRenderer still(device(), *gpuScene_, settings, 1);
        still.render(moment_);
        return still.download();
    }

    dvec3 pointAt(const RenderedLayers& layers, size_t p) const {
        return dvec3(moment_.camera.origin) +
               double{layers.depth[4 * p]} * directionAt(moment_.camera, extent, centreOf(p, extent));
    }

    /// Returns the mirror's position.
    static double mirrorZ() { return mirrorVelocity.z * static_cast<double>(frame) / framesPerSecond; }

    void expectAsThroughAWindow(const RenderedLayers& layers, size_t p, const dvec3& seen) const {
        const uint32_t thing = layers.ids[2 * p];
        const dvec3 normal(0, 0, 1), velocity = thing == block ? blockVelocity : dvec3(0.0);
        const dvec3 seenBefore =
            seen - (reflectedAt(velocity, normal) + 2.0 * glm::dot(mirrorVelocity, normal) * normal) /
                       framesPerSecond;
        const dvec3 is = seenAt(moment_.camera, extent, seen);
        const dvec3 expected = seenAt(*moment_.previousCamera, extent, seenBefore) - is;
        const float* motion = &layers.motion[4 * p];
        ASSERT_EQ(motion[3], 1.0f);
        EXPECT_LT(glm::length(expected - dvec3(vec3(motion[0], motion[1], motion[2]))), 0.01) << thing;
        const vec3 n(layers.normal[4 * p], layers.normal[4 * p + 1], layers.normal[4 * p + 2]);
        const vec3 before(layers.previousNormal[4 * p], layers.previousNormal[4 * p + 1],
                          layers.previousNormal[4 * p + 2]);
        EXPECT_LT(glm::length(n - before), 1e-3f) << "nothing turns";
        EXPECT_LE(glm::dot(dvec3(n), seen - dvec3(moment_.camera.origin)), 1e-3) << "faces the viewer";
        if (thing == ground) {
            EXPECT_LT(glm::length(n - vec3(0, 1, 0)), 1e-3f);
        }
    }

    void expectLightOfTheThing(const scene::Scene& scene, const RenderedLayers& layers, size_t p) const {
        const uint32_t thing = layers.ids[2 * p];
        const float* albedo = &layers.albedo[4 * p];
        const vec3 own(scene.materials[thing].baseColor), tint(scene.materials[mirror].baseColor);
        for (int c = 0; c < 3; ++c) {
            // Schlick's term makes any metal whiter than its colour.
            EXPECT_GE(albedo[c], own[c] * tint[c] - 1e-4f);
            EXPECT_LE(albedo[c], own[c] + 1e-4f);
            EXPECT_NEAR(layers.specular[4 * p + static_cast<size_t>(c)], 0.0f, 1e-6f)
                << "the thing has diffuse light";
            if (thing != lamp) continue;
            const float shown = layers.emission[4 * p + static_cast<size_t>(c)];
            EXPECT_GE(shown, lampRadiance[c] * tint[c] - 1e-3f);
            EXPECT_LE(shown, lampRadiance[c] + 1e-3f);
        }
    }

    Moment moment_;
};

TEST_F(MirrorTest, LayersAreThoseOfAWindow) {
    const scene::Scene scene = mirrorScene(0.0f);
    const RenderedLayers layers = layersOf(scene, true);
    std::array<size_t, 4> seen{};
    for (size_t p = 0; p < size_t{extent.width} * extent.height; ++p) {
        if (layers.depth[4 * p + 1] == 0.0f) continue;
        const dvec3 point = pointAt(layers, p);
        ASSERT_NE(layers.ids[2 * p], mirror);
        if (point.z > mirrorZ() - 1e-3) continue;
        ++seen[layers.ids[2 * p]];
        expectAsThroughAWindow(layers, p, point);
        expectLightOfTheThing(scene, layers, p);
        if (HasFailure()) FAIL() << "pixel " << p % extent.width << ", " << p / extent.width;
    }
    for (const Thing thing : {block, ground, lamp})
        EXPECT_GT(seen[thing], 100u) << "proves little: " << thing;
}

TEST_F(MirrorTest, LayersAreTheMirrorsOwnWhereItIsRoughOrNotLookedThrough) {
    for (const bool rough : {false, true}) {
        const RenderedLayers layers = layersOf(mirrorScene(rough ? 0.3f : 0.0f), rough);
        size_t seen = 0;
        for (size_t p = 0; p < size_t{extent.width} * extent.height; ++p) {
            if (layers.ids[2 * p] != mirror) continue;
            ++seen;
            EXPECT_NEAR(pointAt(layers, p).z, mirrorZ(), 1e-3);
            EXPECT_EQ(layers.diffuse[4 * p], 0.0f);
        }
        EXPECT_GT(seen, 1000u);
    }
}

TEST_F(MirrorTest, ReflectionsMoveAsWhatTheMirrorShows) {
    const scene::Scene scene = mirrorScene(0.0f);
    const RenderedLayers through = layersOf(scene, true), own = layersOf(scene, false);
    const double before = mirrorZ() - mirrorVelocity.z / framesPerSecond;
    size_t seen = 0;
    for (size_t p = 0; p < size_t{extent.width} * extent.height; ++p) {
        const float *reflection = &own.reflectionMotion[4 * p], *motion = &through.motion[4 * p];
        if (own.ids[2 * p] != mirror) {
            ASSERT_EQ(reflection[3], 0.0f) << "nothing else is smooth";
            continue;
        }
        ++seen;
        ASSERT_EQ(reflection[3], motion[3]);
        EXPECT_NEAR(reflection[0], motion[0], 0.01f);
        EXPECT_NEAR(reflection[1], motion[1], 0.01f);
        const CameraParams& camera = *moment_.previousCamera;
        const dvec2 at = centreOf(p, extent) + dvec2(double{reflection[0]}, double{reflection[1]});
        const dvec3 ray = directionAt(camera, extent, at);
        const double distance = (before - double{camera.origin.z}) / ray.z;
        EXPECT_NEAR(double{reflection[2]}, distance - double{own.depth[4 * p]}, 1e-3);
        if (HasFailure()) FAIL() << "pixel " << p % extent.width << ", " << p / extent.width;
    }
    EXPECT_GT(seen, 1000u);
}

TEST_F(MirrorTest, ReflectedRaysAreAsLongAsWhatTheMirrorShowsIsFarBehindIt) {
    const scene::Scene scene = mirrorScene(0.0f);
    const RenderedLayers through = layersOf(scene, true), own = layersOf(scene, false);
    size_t seen = 0;
    for (size_t p = 0; p < size_t{extent.width} * extent.height; ++p) {
        if (own.ids[2 * p] != mirror) continue;
        ++seen;
        EXPECT_EQ(own.roughness[4 * p], 0.0f);
        ASSERT_EQ(own.hitDistance[4 * p + 1], 1.0f);
        if (through.depth[4 * p + 1] == 0.0f) {
            EXPECT_EQ(own.hitDistance[4 * p], 1e9f) << "the sky";
        } else {
            EXPECT_NEAR(own.depth[4 * p] + own.hitDistance[4 * p], through.depth[4 * p], 1e-3f);
        }
        if (HasFailure()) FAIL() << "pixel " << p % extent.width << ", " << p / extent.width;
    }
    EXPECT_GT(seen, 1000u);
    const RenderedLayers rough = layersOf(mirrorScene(0.3f), false);
    for (size_t p = 0; p < size_t{extent.width} * extent.height; ++p) {
        if (rough.ids[2 * p] != mirror) continue;
        EXPECT_NEAR(rough.roughness[4 * p], 0.3f, 1e-4f);
    }
}

/// The picture of lab-mirror and its reflection, in frames of one sample with a moving camera.
class MirroredPictureTest : public SequenceTest {
  protected:
    static constexpr gpu::Extent extent{160, 90};
    static constexpr std::array<uint64_t, 2> judged{12, 18};
    static constexpr uint64_t referenceSamples = 256;

    struct Flip {
        double direct = 0.0, reflected = 0.0;
        size_t directPixels = 0, reflectedPixels = 0;
    };

    void SetUp() override {
        RenderTest::SetUp();
        if (IsSkipped()) return;
        load(scene::labMirrorScene(), {}, "orbit", 4.0);
    }

    RenderSettings settings() const {
        RenderSettings result = centred(extent.width, extent.height, 8);
        result.layers = true;
        return result;
    }

    /// True if the pixel's centre is in the quadrangle with these corners.
    static bool lies(const dvec2& at, const CameraParams& camera, const std::array<vec3, 4>& corners) {
        int side = 0;
        for (size_t i = 0; i < 4; ++i) {
            const dvec2 a(seenAt(camera, extent, dvec3(corners[i])));
            const dvec2 b(seenAt(camera, extent, dvec3(corners[(i + 1) % 4])));
            side += (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x) > 0.0 ? 1 : -1;
        }
        return std::abs(side) == 4;
    }

    void judge(const RenderedLayers& layers, uint64_t frame, Flip& flip) {
        const image::Image truth = reference(frame, settings(), referenceSamples);
        const image::Image map =
            image::compare(beautyOf(layers), truth, *image::measuredExposure(truth)).flipMap;
        const CameraParams camera = sequence_->moment(frame, extent).camera;
        const scene::MirrorLab& lab = scene::mirrorLab();
        std::array<vec3, 4> reflected = lab.panelCorners;
        for (vec3& corner : reflected) corner = lab.reflected(corner);
        for (size_t p = 0; p < map.pixels.size(); ++p) {
            const dvec2 at = centreOf(p, extent);
            // The panel hides part of its own reflection.
            if (lies(at, camera, lab.panelCorners)) {
                flip.direct += double{map.pixels[p]};
                ++flip.directPixels;
            } else if (lies(at, camera, reflected)) {
                flip.reflected += double{map.pixels[p]};
                ++flip.reflectedPixels;
            }
        }
    }

    Flip flipOf(const std::string& denoiser) {
        RenderSettings chosen = settings();
        chosen.pipeline = parsePipeline("path", denoiser);
        FrameRenderer renderer(device(), *gpuScene_, chosen, 1);
        Flip flip;
        for (uint64_t frame = 0; frame <= judged.back(); ++frame) {
            renderer.render(sequence_->moment(frame, extent));
            if (std::count(judged.begin(), judged.end(), frame) > 0) judge(renderer.download(), frame, flip);
        }
        flip.direct /= static_cast<double>(flip.directPixels);
        flip.reflected /= static_cast<double>(flip.reflectedPixels);
        return flip;
    }
};

TEST_F(MirroredPictureTest, IsAsCleanAsThePictureItself) {
    const Flip flip = flipOf("svgf");
    fmt::print("FLIP {:.4f} directly ({} pixels), {:.4f} in the mirror ({})\n", flip.direct,
               flip.directPixels, flip.reflected, flip.reflectedPixels);
    EXPECT_GT(flip.directPixels, 1000u);
    EXPECT_GT(flip.reflectedPixels, 1000u);
    EXPECT_LE(flip.reflected, 1.25 * flip.direct);
}

}  // namespace
}  // namespace limpid::test
