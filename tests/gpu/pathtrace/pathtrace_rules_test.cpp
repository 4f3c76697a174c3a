// Tests properties of any picture: repeatability, seeds, launches, layers, parameters, counters.
#include <glm/gtc/matrix_transform.hpp>

#include "scene/builtin/builtin.h"
#include "scene/builtin/builtin_parts.h"
#include "tests/gpu/render_fixture.h"
#include "tests/reference/statistics.h"

namespace limpid::test {
namespace {

class RulesTest : public RenderTest {
  protected:
    static RenderSettings small(uint32_t size, uint32_t samplesPerLaunch) {
        RenderSettings settings;
        settings.extent = {size, size};
        settings.samplesPerLaunch = samplesPerLaunch;
        return settings;
    }

    /// The means of what the glass sphere shows, seen through and not.
    struct GlassMeans {
        double with = 0.0, without = 0.0;
        size_t pixels = 0;
    };
    GlassMeans meansOfGlass(float transmission);
};

TEST_F(RulesTest, TheSameSeedGivesTheSameBits) {
    Renderer renderer(device(), scene::cornellSpheresScene());
    RenderSettings settings = small(24, 2);
    const Rendered first = renderer(settings, 8), second = renderer(settings, 8);
    EXPECT_EQ(first.layers.beauty, second.layers.beauty);
    EXPECT_EQ(first.counters.rays, second.counters.rays);
    settings.seed = 1;
    EXPECT_NE(renderer(settings, 8).layers.beauty, first.layers.beauty);
}

TEST_F(RulesTest, NoSampleIsRejectedWhereNothingIsNaN) {
    for (const char* name : {"cornell", "cornell-spheres", "furnace"}) {
        const Rendered picture = render(scene::builtinScene(name), small(32, 16), 32);
        EXPECT_EQ(picture.counters.rejected, 0u) << name;
        EXPECT_GT(picture.counters.rays, 32u * 32u * 32u) << name;
        for (const float value : picture.layers.beauty) ASSERT_TRUE(std::isfinite(value)) << name;
    }
}

/// Samples per launch change the noise, but not the mean.
TEST_F(RulesTest, SamplesPerLaunchKeepTheMean) {
    Renderer renderer(device(), scene::cornellScene());
    RenderSettings settings = small(24, 1);
    settings.layers = true;
    constexpr uint64_t samples = 256;
    const Rendered one = renderer(settings, samples);
    settings.samplesPerLaunch = 4;
    settings.seed = 99;
    const Rendered four = renderer(settings, samples);
    double beyond = 0, count = 0, sum = 0;
    for (size_t i = 0; i < one.pixelCount(); ++i) {
        // Alpha is the variance of one sample's luminance.
        const auto luminance = [&](const Rendered& r) {
            const float* p = &r.layers.diffuse[4 * i];
            return 0.2126 * double{p[0]} + 0.7152 * double{p[1]} + 0.0722 * double{p[2]};
        };
        const double variance =
            double{one.layers.diffuse[4 * i + 3]} + double{four.layers.diffuse[4 * i + 3]};
        if (variance <= 0.0) continue;
        const double z = (luminance(one) - luminance(four)) / std::sqrt(variance / samples);
        ++count;
        sum += z;
        beyond += std::abs(z) > 3.0;
    }
    fmt::print("launches of 1 and 4: {} of {} pixels beyond 3 sigma, mean z {:.3f}\n", beyond, count,
               sum / count);
    EXPECT_GT(count, 300);
    EXPECT_LE(beyond, 0.015 * count);
    EXPECT_LT(std::abs(sum / std::sqrt(count)), 4.0);
}

TEST_F(RulesTest, LayersAddUpToTheBeauty) {
    Renderer renderer(device(), scene::cornellSpheresScene());
    RenderSettings settings = small(32, 4);
    settings.pathtrace.throughGlass = false;  // which samples other paths
    const Rendered beauty = renderer(settings, 16);
    settings.layers = true;
    const Rendered layered = renderer(settings, 16);
    const image::Image sum = beautyOf(layered.layers);
    size_t different = 0;
    for (size_t i = 0; i < beauty.pixelCount(); ++i) {
        const float* d = &layered.layers.diffuse[4 * i];
        const float* s = &layered.layers.specular[4 * i];
        const float* e = &layered.layers.emission[4 * i];
        for (size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(sum.pixels[3 * i + k], d[k] + s[k] + e[k]);
            const float expected = beauty.layers.beauty[4 * i + k];
            if (std::abs(sum.pixels[3 * i + k] - expected) > 1e-4f * expected + 1e-5f) {
                ++different;
                break;
            }
        }
    }
    // Two shaders may round differently, after which a path may diverge.
    EXPECT_LE(different, beauty.pixelCount() / 50) << "of " << beauty.pixelCount() << " pixels";
    fmt::print("layers: {} of {} pixels differ from the beauty by more than rounding\n", different,
               beauty.pixelCount());
}

RulesTest::GlassMeans RulesTest::meansOfGlass(float transmission) {
    scene::Scene scene = scene::cornellSpheresScene();
    for (scene::Material& material : scene.materials)
        if (material.transmission > 0.0f) material.transmission = transmission;
    scene.cameras.clear();
    scene::addCamera(scene, {0.13f, 0.14f, 0.9f}, {0.13f, 0.1f, 0.1f}, 0.24f);
    Renderer renderer(device(), scene);
    RenderSettings settings = small(20, 64);
    settings.layers = true;
    settings.jitter = Jitter::Off;  // a pixel sees glass in every sample or in none
    const image::Image with = beautyOf(renderer(settings, 2048).layers);
    settings.pathtrace.throughGlass = false;
    settings.seed = 1;
    const RenderedLayers own = renderer(settings, 2048).layers;
    const image::Image without = beautyOf(own);
    constexpr uint32_t glass = 1;  // the instances are the room and the three spheres
    GlassMeans means;
    for (size_t i = 0; i < own.ids.size() / 2; ++i) {
        if (own.ids[2 * i] != glass) continue;
        ++means.pixels;
        for (size_t c = 0; c < 3; ++c) {
            means.with += with.pixels[3 * i + c];
            means.without += without.pixels[3 * i + c];
        }
    }
    return means;
}

/// Georeferenced and CAD data have large coordinates, which a node takes back. The tracer rounds to them.
TEST_F(RulesTest, InstancesWithLargeCoordinatesOfTheirOwnDoNotShadowThemselves) {
    scene::MeshBuilder builder("floor");  // with so many triangles that two of them share one tree
    for (int i = 0; i < 2304; ++i) {
        const auto x = static_cast<float>(i % 48 - 24), z = static_cast<float>(i / 48 - 24);
        builder.quad({x, 0, z + 1}, {x + 1, 0, z + 1}, {x + 1, 0, z}, {x, 0, z});
    }
    scene::Scene scene;
    scene::Material material = lambertian(vec3(0.8f));
    material.doubleSided = true;
    addMesh(scene, builder.take(), material);
    scene.lights.push_back({.kind = scene::PunctualLight::Kind::Directional,
                            .direction = glm::normalize(vec3(-0.5f, -1.0f, -0.2f)),
                            .intensity = vec3(2.0f)});
    scene::addCamera(scene, {0.0f, 3.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 0.5f);
    const mat4 turned = glm::rotate(mat4(1.0f), 0.3f, glm::normalize(vec3(1.0f, 0.2f, 0.5f)));
    scene.instances.at(0).transform = turned;
    scene.instances.push_back(scene.instances.at(0));
    scene.instances.at(1).transform = glm::translate(mat4(1.0f), vec3(0.0f, -60.0f, 0.0f));
    const Rendered expected = render(scene, small(24, 1), 4);
    // Oblique, so that rounded coordinates lie on either side of the floor.
    const mat4 placed = glm::translate(mat4(1.0f), {8765.4f, 9876.5f, 7654.3f}) *
                        glm::rotate(mat4(1.0f), 0.7f, glm::normalize(vec3(0.3f, 0.9f, 1.0f)));
    for (vec3& position : scene.meshes.at(0).positions) position = vec3(placed * vec4(position, 1.0f));
    for (scene::Instance& instance : scene.instances)
        instance.transform = instance.transform * glm::inverse(placed);
    EXPECT_TRUE(scene::buildSceneData(scene).features.twoLevel);
    const Rendered picture = render(scene, small(24, 1), 4);
    double sum = 0.0;
    for (size_t p = 0; p < picture.pixelCount(); ++p) {
        EXPECT_NEAR(picture.beauty(p).x, expected.beauty(p).x, 0.02f) << p;
        sum += double{expected.beauty(p).x} / static_cast<double>(picture.pixelCount());
    }
    EXPECT_GT(sum, 0.1);
}

/// Shadow rays must end before such lamps.
TEST_F(RulesTest, LampsWithLargeCoordinatesOfTheirOwnDoNotShadowThemselves) {
    scene::MeshBuilder builder("lamp");  // with so many triangles that two of them share one tree
    constexpr float side = 1.0f / 12.0f;
    for (int i = 0; i < 2304; ++i) {
        const float x = side * static_cast<float>(i % 48 - 24), z = side * static_cast<float>(i / 48 - 24);
        builder.quad({x, 3, z}, {x + side, 3, z}, {x + side, 3, z + side}, {x, 3, z + side});
    }
    scene::Scene scene = floorScene(vec3(0.8f));
    addMesh(scene, builder.take(), scene::emitter("lamp", vec3(0.5f), vec3(3.0f)));
    scene::addCamera(scene, {0.0f, 2.5f, 3.0f}, {0.0f, 0.0f, 0.0f}, 0.5f);
    scene.instances.push_back(scene.instances.at(1));
    scene.instances.at(2).transform = glm::translate(mat4(1.0f), vec3(0.0f, -60.0f, 0.0f));
    RenderSettings settings = small(24, 4);
    settings.pathtrace.maxDepth = 1;
    const double expected = meanOfRed(render(scene, settings, 64));
    const mat4 placed = glm::translate(mat4(1.0f), {8765.4f, 9876.5f, 7654.3f}) *
                        glm::rotate(mat4(1.0f), 0.7f, glm::normalize(vec3(0.3f, 0.9f, 1.0f)));
    for (vec3& position : scene.meshes.at(1).positions) position = vec3(placed * vec4(position, 1.0f));
    for (const size_t i : {size_t{1}, size_t{2}}) scene.instances.at(i).transform *= glm::inverse(placed);
    EXPECT_TRUE(scene::buildSceneData(scene).features.twoLevel);
    const double found = meanOfRed(render(scene, settings, 64));
    fmt::print("lamps with large coordinates: {:.4f} of the light\n", found / expected);
    EXPECT_NEAR(found / expected, 1.0, 0.02);
}

/// Of edges of 7e11, whose areas squared overflow, and of 2e-11, whose areas squared underflow.
TEST_F(RulesTest, TheSizeOfASceneDoesNotMatter) {
    const auto picture = [&](int exponent) {
        const float size = std::ldexp(1.0f, exponent);
        scene::Scene scene = floorScene(vec3(0.8f));
        scene::MeshBuilder lamp("lamp");
        scene::addLamp(lamp, {0.0f, 2.0f, 0.0f}, 1.0f, 1.0f, 0);
        addMesh(scene, lamp.take(), scene::emitter("lamp", vec3(0.5f), vec3(5.0f)));
        for (scene::Mesh& mesh : scene.meshes)
            for (vec3& position : mesh.positions) position *= size;
        scene::addCamera(scene, size * vec3(0.0f, 3.0f, 4.0f), vec3(0.0f), 0.5f);
        return render(scene, small(16, 4), 16);
    };
    const Rendered expected = picture(0);
    for (const int exponent : {35, -40}) {
        const Rendered sized = picture(exponent);
        EXPECT_EQ(sized.counters.rejected, 0u) << exponent;
        size_t different = 0;
        for (size_t p = 0; p < expected.pixelCount(); ++p) {
            const float light = expected.beauty(p).x;
            different += !(std::abs(sized.beauty(p).x - light) <= 1e-3f * light + 1e-5f);
        }
        EXPECT_LE(different, expected.pixelCount() / 50) << exponent;
    }
    EXPECT_GT(meanOfRed(expected), 0.1);
}

/// KHR_materials_unlit: "the emissive factor and texture are ignored".
TEST_F(RulesTest, UnlitMaterialsAreNoLamps) {
    scene::Scene scene = floorScene(vec3(0.8f));
    scene::addCamera(scene, {0.0f, 3.0f, 4.0f}, {0.0f, 0.0f, 0.0f}, 0.5f);
    scene::MeshBuilder sign("sign");
    scene::addLamp(sign, {0.0f, 2.0f, 0.0f}, 1.0f, 1.0f, 0);
    scene::Material material = scene::emitter("sign", vec3(0.2f), vec3(0.0f));
    material.unlit = true;
    addMesh(scene, sign.take(), material);
    const Rendered expected = render(scene, small(24, 4), 64);
    scene.materials.back().emission = vec3(50.0f);
    EXPECT_FALSE(isEmitter(scene.materials.back()));
    EXPECT_EQ(render(scene, small(24, 4), 64).layers.beauty, expected.layers.beauty);
}

TEST_F(RulesTest, SeeingThroughGlassKeepsTheMean) {
    for (const float transmission : {1.0f, 0.8f}) {
        const GlassMeans means = meansOfGlass(transmission);
        fmt::print("glass that transmits {}: mean {:.4f} of that without seeing through, {} pixels\n",
                   transmission, means.with / means.without, means.pixels);
        EXPECT_GT(means.pixels, 250u) << "proves little";
        EXPECT_NEAR(means.with / means.without, 1.0, 0.01);
    }
}

TEST_F(RulesTest, EveryParameterChangesThePicture) {
    scene::Scene scene = scene::cornellSpheresScene();
    for (int i = 0; i < 2; ++i) {  // power alone would starve these lamps, so there is a tree
        scene::MeshBuilder lamp("dim lamp");
        scene::addLamp(lamp, {0.3f * static_cast<float>(i) - 0.15f, 0.3f, 0.0f}, 0.05f, 0.05f, 0);
        addMesh(scene, lamp.take(), scene::emitter("dim lamp", vec3(0.5f), vec3(0.01f)));
    }
    Renderer renderer(device(), scene);
    RenderSettings settings = small(24, 4);
    settings.layers = true;
    const RenderedLayers before = renderer(settings, 8).layers;
    const auto& table = pathtraceParams();
    for (const ParamInfo& info : table.infos()) {
        RenderSettings changed = settings;
        const std::string value = std::holds_alternative<bool>(info.defaultValue)
                                      ? (std::get<bool>(info.defaultValue) ? "off" : "on")
                                  : std::holds_alternative<int>(info.defaultValue) ? "1"
                                                                                   : "0.05";
        ASSERT_TRUE(table.set(changed.pathtrace, info.name, value));
        ASSERT_NE(changed.pathtrace, settings.pathtrace) << info.name << " = " << value << " is the default";
        const RenderedLayers after = renderer(changed, 8).layers;
        EXPECT_TRUE(after.diffuse != before.diffuse || after.specular != before.specular)
            << info.name << " = " << value;
    }
}

TEST_F(RulesTest, JitterMovesTheRays) {
    Renderer renderer(device(), scene::cornellScene());
    RenderSettings settings = small(16, 1);
    settings.pathtrace.maxDepth = 0;
    settings.layers = true;
    std::vector<std::vector<float>> depths;
    for (const Jitter jitter : {Jitter::Off, Jitter::Frame, Jitter::Pixel}) {
        settings.jitter = jitter;
        // The first frame goes through the pixels' centres in every mode.
        const Rendered first = renderer(settings, 1);
        depths.push_back(renderer(settings, 4).layers.depth);
        if (jitter == Jitter::Off) continue;
        settings.jitter = Jitter::Off;
        EXPECT_EQ(first.layers.depth, renderer(settings, 1).layers.depth);
    }
    EXPECT_NE(depths[0], depths[1]);
    EXPECT_NE(depths[0], depths[2]);
    EXPECT_NE(depths[1], depths[2]);
}

}  // namespace
}  // namespace limpid::test
