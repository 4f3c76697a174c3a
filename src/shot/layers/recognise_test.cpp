// Tests that the layers of each renderer's files are found, by files with exactly their channels.
#include "shot/layers/recognise.h"

#include "base/error.h"
#include "shot/camera/camera_attributes.h"
#include "shot/layers/recognise_fixture.h"

namespace limpid::shot {
namespace {

using test::allOf;
using test::cyclesChannels;
using test::names;
using test::TestPart;
using testing::HasSubstr;

using RecogniseTest = test::RecogniseTest;

TEST_F(RecogniseTest, Cycles) {
    image::ExrDocument document = file({{.channels = cyclesChannels("View Layer.001.")}});
    const std::vector<LayerMap> maps = recognise(document, {});
    ASSERT_EQ(maps.size(), 1u);
    const LayerMap& map = maps.front();
    EXPECT_EQ(map.renderer, "Cycles (Blender)");
    EXPECT_EQ(map.title, "View Layer.001");
    EXPECT_EQ(textOf(map, "beauty"), "View Layer.001.Combined.RGB");
    EXPECT_EQ(textOf(map, "diffuse"),
              "View Layer.001.DiffCol.RGB * View Layer.001.DiffDir.RGB + "
              "View Layer.001.DiffCol.RGB * View Layer.001.DiffInd.RGB");
    // Without passes of transmission, the terms of glossy light remain.
    EXPECT_EQ(textOf(map, "albedoSpecular"), "View Layer.001.GlossCol.RGB");
    EXPECT_EQ(textOf(map, "emission"), "View Layer.001.Emit.RGB");
    EXPECT_EQ(textOf(map, "normal"), "View Layer.001.Normal.XYZ");
    EXPECT_EQ(map.encoding.normalSpace, NormalSpace::World);
    EXPECT_EQ(textOf(map, "depth"), "View Layer.001.Depth.Z");
    EXPECT_EQ(map.encoding.depthKind, DepthKind::Planar);
    EXPECT_EQ(textOf(map, "motion"), "View Layer.001.Vector.XY");
    EXPECT_EQ(map.encoding.motionScale, vec2(1, -1));
    const float product = 4.0f + static_cast<float>(std::string("View Layer.001.DiffCol").size() - 2);
    const image::Image diffuse = map.find("diffuse")->evaluate(document);
    EXPECT_EQ(diffuse.components, 3u);
    EXPECT_EQ(diffuse.at(1, 1, 2), 2.0f * product * product);
}

TEST_F(RecogniseTest, EachViewLayerIsAPicture) {
    const auto maps =
        recognise(file({{.channels = allOf({cyclesChannels("A."), cyclesChannels("B.")})}}), {});
    ASSERT_EQ(maps.size(), 2u);
    EXPECT_EQ(textOf(maps[0], "depth"), "A.Depth.Z");
    EXPECT_EQ(textOf(maps[1], "depth"), "B.Depth.Z");
}

/// The compositor's result has no guides, and sorts before the layers that it was made of.
TEST_F(RecogniseTest, BlendersCompositeIsLeftAsItWas) {
    const std::vector<std::string> composite = names("R G B A", "Composite.Combined.");
    const auto document = file({{.channels = allOf({composite, cyclesChannels("ViewLayer.")})}});
    auto maps = recognise(document, {});
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_EQ(maps[0].title, "ViewLayer");
    ASSERT_EQ(maps[0].remarks.size(), 1u);
    EXPECT_THAT(maps[0].remarks[0], HasSubstr("'Composite' stays as it was"));
    maps = recognise(document, {{"beauty", "Composite.Combined.RGB"}});
    EXPECT_EQ(textOf(maps.at(0), "beauty"), "Composite.Combined.RGB");
    EXPECT_THAT(maps[0].remarks, testing::IsEmpty());
    maps = recognise(file({{.channels = composite}}), {});
    EXPECT_EQ(maps.at(0).title, "Composite") << "there is nothing better";
    EXPECT_THAT(maps[0].remarks, testing::IsEmpty());
}

TEST_F(RecogniseTest, BlendersNoisyImageIsCleanedInPlaceOfItsOwnCleanOne) {
    const auto document =
        file({{.channels = allOf({names("R G B A", "Composite.Combined."), names("R G B A", "V.Combined."),
                                  names("R G B A", "V.Noisy Image.")})}});
    auto maps = recognise(document, {});
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_EQ(textOf(maps[0], "beauty"), "V.Noisy Image.RGB");
    EXPECT_EQ(textOf(maps[0], "alpha"), "V.Combined.A");
    EXPECT_EQ(maps[0].target().text(), "V.Combined.RGB");
    ASSERT_EQ(maps[0].remarks.size(), 2u);
    EXPECT_THAT(maps[0].remarks[0], HasSubstr("'V.Combined' is denoised already; 'V.Noisy Image' is"));
    maps = recognise(document, {{"beauty", "V.Combined.RGB"}});
    EXPECT_EQ(textOf(maps.at(0), "beauty"), "V.Combined.RGB");
    EXPECT_EQ(maps[0].target().text(), "V.Combined.RGB");
}

TEST_F(RecogniseTest, OldPassesOfBlenderWithDenoisingDataOnly) {
    const auto maps = recognise(file({{.channels = allOf({names("R G B A", "ViewLayer.Combined."),
                                                          names("R G B", "ViewLayer.Denoising Albedo."),
                                                          names("X Y Z", "ViewLayer.Denoising Normal.")})}}),
                                {});
    EXPECT_EQ(textOf(maps.at(0), "albedo"), "ViewLayer.Denoising Albedo.RGB");
    EXPECT_EQ(textOf(maps[0], "normal"), "ViewLayer.Denoising Normal.XYZ");
    EXPECT_EQ(maps[0].encoding.normalSpace, NormalSpace::Camera);
    EXPECT_EQ(maps[0].encoding.normalScale, vec3(1, 1, -1));
    EXPECT_EQ(textOf(maps[0], "diffuse"), "");
}

/// Blender 5 writes a part for each pass, whose channels have full names.
TEST_F(RecogniseTest, BlenderFive) {
    const auto part = [](const std::string& pass, const std::string& components) {
        return TestPart{.name = "ViewLayer." + pass,
                        .channels = names(components, "ViewLayer." + pass + ".")};
    };
    const auto maps =
        recognise(file({part("Combined", "R G B A"), part("Depth", "Z"), part("Diffuse Color", "R G B"),
                        part("Diffuse Direct", "R G B"), part("Glossy Color", "R G B"),
                        part("Glossy Direct", "R G B"), part("Emission", "R G B"), part("Normal", "X Y Z"),
                        part("Object Index", "X"), part("Vector", "X Y Z W")}),
                  {});
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_EQ(textOf(maps[0], "diffuse"), "ViewLayer.Diffuse Color.RGB * ViewLayer.Diffuse Direct.RGB");
    EXPECT_EQ(textOf(maps[0], "specular"), "ViewLayer.Glossy Color.RGB * ViewLayer.Glossy Direct.RGB");
    EXPECT_EQ(textOf(maps[0], "id"), "ViewLayer.Object Index.X");
    EXPECT_EQ(maps[0].find("depth")->terms()[0].factors[0].channels[0].part, 1u);
}

TEST_F(RecogniseTest, Mitsuba) {
    const auto maps = recognise(
        file({{.channels =
                   names("R G B image.R image.G image.B albedo.R albedo.G albedo.B nn.X nn.Y nn.Z dd.y.T"),
               .texts = {{"generatedBy", "Mitsuba version 3.5.2"}}}}),
        {});
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_EQ(maps[0].renderer, "Mitsuba 3");
    EXPECT_EQ(textOf(maps[0], "beauty"), "RGB");
    EXPECT_EQ(textOf(maps[0], "albedo"), "albedo.RGB");
    EXPECT_EQ(textOf(maps[0], "normal"), "nn.XYZ");
    EXPECT_EQ(textOf(maps[0], "depth"), "dd.y.T");
    EXPECT_EQ(maps[0].encoding.depthKind, DepthKind::Distance);
}

/// Each triangle has another prim_index.
TEST_F(RecogniseTest, MitsubasShapesAreObjectsAndItsTrianglesAreNot) {
    const auto idOf = [&](const std::string& layers) {
        return textOf(recognise(file({{.channels = names("R G B A " + layers),
                                       .texts = {{"generatedBy", "Mitsuba version 3.5.2"}}}}),
                                {})
                          .at(0),
                      "id");
    };
    EXPECT_EQ(idOf("prim_index.I"), "");
    EXPECT_EQ(idOf("prim_index.I shape_index.I"), "shape_index.I");
}

/// Alpha is that of the beauty, by which all renderers multiply colours.
TEST_F(RecogniseTest, AlphaIsInTheBeautysLayer) {
    const auto alphaOf = [&](const TestPart& part) {
        const LayerMap map = recognise(file({part}), {}).at(0);
        return map.renderer + ": " + textOf(map, "alpha");
    };
    EXPECT_EQ(alphaOf({.channels = names("R G B A")}), "unknown: A");
    EXPECT_EQ(alphaOf({.channels = names("rgba.R rgba.G rgba.B rgba.A A.X")}), "unknown: rgba.A");
    EXPECT_EQ(alphaOf({.channels = names("R G B")}), "unknown: ");
    EXPECT_EQ(alphaOf({.channels = names("RGBA.R RGBA.G RGBA.B RGBA.A"),
                       .texts = {{"arnold/version", "Arnold 7.4.2.1"}}}),
              "Arnold: RGBA.A");
    EXPECT_EQ(alphaOf({.channels = names("Ci.r Ci.g Ci.b a mse.r mse.g mse.b")}), "RenderMan: a");
    EXPECT_EQ(alphaOf({.channels = names("C.R C.G C.B C.A albedodiffuse.R")}), "Karma: C.A");
    EXPECT_EQ(alphaOf({.channels = names("R G B A"), .texts = {{"generatedBy", "Mitsuba version 3.5.2"}}}),
              "Mitsuba 3: A");
}

TEST_F(RecogniseTest, Pbrt) {
    for (const std::string geometry :
         {"P.X P.Y P.Z N.X N.Y N.Z Ns.X Ns.Y Ns.Z", "Px Py Pz Nx Ny Nz Nsx Nsy Nsz"}) {
        const auto maps = recognise(
            file({{.channels = names("R G B Albedo.R Albedo.G Albedo.B dzdx dzdy u v Variance.R Variance.G "
                                     "Variance.B RelativeVariance.R RelativeVariance.G RelativeVariance.B " +
                                     geometry)}}),
            {});
        EXPECT_EQ(maps.at(0).renderer, "pbrt-v4");
        EXPECT_EQ(textOf(maps[0], "albedo"), "Albedo.RGB");
        EXPECT_NE(textOf(maps[0], "normal"), "") << geometry;
        EXPECT_NE(textOf(maps[0], "depth"), "") << geometry;
        EXPECT_EQ(maps[0].encoding.normalScale, vec3(1, 1, -1));
    }
}

/// A camera at (0, 0, 5) that looks along -z: row vectors, z forwards; the film is 2 : 1, 90 degrees wide.
TEST_F(RecogniseTest, ArnoldWithItsCamera) {
    const Imath::M44f toCamera(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 5, 1);
    const Imath::M44f toClip(1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 1, 0, 0, -0.1f, 0);
    const image::ExrDocument document =
        file({{.channels = names("R G B A Z N.X N.Y N.Z denoise_albedo.R denoise_albedo.G denoise_albedo.B "
                                 "diffuse_direct.R diffuse_direct.G diffuse_direct.B diffuse_indirect.R "
                                 "diffuse_indirect.G diffuse_indirect.B specular.R specular.G specular.B"),
               .texts = {{"arnold/version", "Arnold 7.4.2.1"}},
               .matrices = {{"worldToCamera", toCamera}, {"worldToScreen", toCamera * toClip}}}});
    const auto maps = recognise(document, {});
    EXPECT_EQ(maps.at(0).renderer, "Arnold");
    EXPECT_EQ(textOf(maps[0], "diffuse"), "diffuse_direct.RGB + diffuse_indirect.RGB");
    EXPECT_EQ(textOf(maps[0], "specular"), "specular.RGB");
    EXPECT_EQ(textOf(maps[0], "albedo"), "denoise_albedo.RGB");
    EXPECT_EQ(textOf(maps[0], "depth"), "Z");
    const auto camera = cameraOfAttributes(document);
    ASSERT_TRUE(camera);
    EXPECT_EQ(camera->origin, vec3(0, 0, 5));
    EXPECT_EQ(camera->forward, vec3(0, 0, -1));
    EXPECT_NEAR(camera->right.x, 1.0f, 1e-5f);
    EXPECT_NEAR(camera->up.y, 0.5f, 1e-5f);
}

TEST_F(RecogniseTest, WidePixelsMakeTheCamerasViewLower) {
    const Imath::M44f toCamera(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 5, 1);
    const Imath::M44f toClip(1, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1, 1, 0, 0, -0.1f, 0);
    const auto camera = cameraOfAttributes(
        file({{.channels = names("R G B"),
               .matrices = {{"worldToCamera", toCamera}, {"worldToScreen", toCamera * toClip}},
               .pixelAspect = 2.0f}}));
    ASSERT_TRUE(camera);
    EXPECT_NEAR(camera->right.x, 1.0f, 1e-5f);
    EXPECT_NEAR(camera->up.y, 0.25f, 1e-5f);
}

/// pbrt writes its matrices for column vectors, and no angle of view that could be used.
TEST_F(RecogniseTest, MatricesForColumnVectorsAreNoticed) {
    const Imath::M44f toCamera(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 5, 0, 0, 0, 1);
    image::ExrDocument document =
        file({{.channels = names("R G B"), .matrices = {{"worldToCamera", toCamera}}}});
    EXPECT_FALSE(cameraOfAttributes(document));
    document = file({{.channels = names("R G B"),
                      .matrices = {{"worldToCamera", toCamera},
                                   {"worldToNDC",
                                    Imath::M44f(0.5f, 0, 0.5f, 0, 0, 0.5f, 0.5f, 0, 0, 0, 1, 0, 0, 0, 1, 0) *
                                        toCamera}}}});
    const auto camera = cameraOfAttributes(document);
    ASSERT_TRUE(camera);
    EXPECT_EQ(camera->origin, vec3(0, 0, 5));
}

TEST_F(RecogniseTest, RenderMan) {
    const auto maps = recognise(
        file({{.channels = names("Ci.r Ci.g Ci.b a albedo.r albedo.g albedo.b normal.x normal.y normal.z z "
                                 "mse.r mse.g mse.b diffuse.r diffuse.g diffuse.b specular.r specular.g "
                                 "specular.b motionBack.x motionBack.y sampleCount")}}),
        {});
    EXPECT_EQ(maps.at(0).renderer, "RenderMan");
    EXPECT_EQ(textOf(maps[0], "beauty"), "Ci.RGB");
    EXPECT_EQ(textOf(maps[0], "normal"), "normal.XYZ");
    EXPECT_EQ(textOf(maps[0], "motion"), "motionBack.XY");
    EXPECT_EQ(textOf(maps[0], "depth"), "z");
}

/// Karma's parts have bare channels; the part's name is the layer's.
TEST_F(RecogniseTest, KarmaInParts) {
    const auto maps = recognise(file({{.name = "C", .channels = names("R G B A")},
                                      {.name = "albedo", .channels = names("R G B")},
                                      {.name = "combineddiffuse", .channels = names("R G B")},
                                      {.name = "N", .channels = names("x y z")},
                                      {.name = "depth", .channels = names("Y")}}),
                                {});
    ASSERT_EQ(maps.size(), 1u);
    EXPECT_EQ(maps[0].renderer, "Karma");
    EXPECT_EQ(textOf(maps[0], "beauty"), "C.RGB");
    EXPECT_EQ(textOf(maps[0], "alpha"), "A");
    EXPECT_EQ(textOf(maps[0], "normal"), "N.XYZ");
    EXPECT_EQ(textOf(maps[0], "depth"), "depth.Y");
    EXPECT_EQ(maps[0].find("normal")->terms()[0].factors[0].channels[2].channel, "z");
}

TEST_F(RecogniseTest, BeautyAlbedoAndNormalOfAnyRenderer) {
    const auto maps = recognise(
        file({{.channels = names("R G B albedo.R albedo.G albedo.B normal.X normal.Y normal.Z")}}), {});
    EXPECT_EQ(maps.at(0).renderer, "unknown");
    EXPECT_EQ(textOf(maps[0], "albedo"), "albedo.RGB");
    EXPECT_EQ(textOf(maps[0], "normal"), "normal.XYZ");
    EXPECT_EQ(textOf(maps[0], "depth"), "") << "B is no depth";
}

/// A name is a layer only if it has the components.
TEST_F(RecogniseTest, OneChannelIsNoColour) {
    const auto maps = recognise(file({{.channels = names("R G B albedo.RGB normal.XYZ motion.XY")}}), {});
    for (const char* role : {"albedo", "normal", "motion"}) EXPECT_EQ(textOf(maps.at(0), role), "") << role;
    EXPECT_THROW(recognise(file({{.channels = names("RGB")}}), {}), InputError);
    EXPECT_THROW(recognise(file({{.channels = names("R G B")}}), {{"beauty", ""}}), UsageError);
}

TEST_F(RecogniseTest, LightGroups) {
    const auto maps =
        recognise(file({{.channels = names("V.Combined.R V.Combined.G V.Combined.B V.Combined_key.R "
                                           "V.Combined_key.G V.Combined_key.B V.Combined_odd.R")}}),
                  {});
    ASSERT_EQ(maps.at(0).groups.size(), 1u);
    EXPECT_EQ(maps[0].groups[0].text(), "V.Combined_key.RGB");
}

}  // namespace
}  // namespace limpid::shot
