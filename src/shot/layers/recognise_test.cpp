// Tests that the layers of each renderer's files are found, by files with exactly their channels.
#include "shot/layers/recognise.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "shot/camera/camera_attributes.h"
#include "shot/layers/shot_fixture.h"

namespace limpid::shot {
namespace {

using test::names;
using test::TestPart;
using testing::HasSubstr;

class RecogniseTest : public testing::Test {
  protected:
    /// Each channel's value is its length, so that sums and products can be told apart.
    image::ExrDocument file(const std::vector<TestPart>& parts) {
        const auto value = [](const std::string& channel, uint32_t, uint32_t) {
            return static_cast<float>(channel.size());
        };
        return image::ExrDocument::read(test::writeParts(folder_ / "a.exr", parts, 4, 2, value));
    }

    static std::string textOf(const LayerMap& map, std::string_view role) {
        const LayerExpression* const layer = map.find(role);
        return layer ? layer->text() : "";
    }

    image::test::TempFolder folder_;
};

std::vector<std::string> joined(std::vector<std::vector<std::string>> lists) {
    std::vector<std::string> result;
    for (auto& list : lists) result.insert(result.end(), list.begin(), list.end());
    return result;
}

std::vector<std::string> cyclesChannels(const std::string& view) {
    const auto colors = [&](const std::string& pass) { return names("A B G R", view + pass + "."); };
    return joined({colors("Combined"),
                   colors("DiffDir"),
                   colors("DiffInd"),
                   colors("DiffCol"),
                   colors("GlossDir"),
                   colors("GlossInd"),
                   colors("GlossCol"),
                   colors("Emit"),
                   colors("Env"),
                   names("X Y Z", view + "Normal."),
                   names("W X Y Z", view + "Vector."),
                   names("Depth.Z IndexOB.X", view),
                   names("B G R", view + "Denoising Albedo."),
                   names("X Y Z", view + "Denoising Normal."),
                   {view + "Denoising Depth.Z"}});
}

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
        recognise(file({{.channels = joined({cyclesChannels("A."), cyclesChannels("B.")})}}), {});
    ASSERT_EQ(maps.size(), 2u);
    EXPECT_EQ(textOf(maps[0], "depth"), "A.Depth.Z");
    EXPECT_EQ(textOf(maps[1], "depth"), "B.Depth.Z");
}

/// The compositor's result has no guides, and sorts before the layers that it was made of.
TEST_F(RecogniseTest, BlendersCompositeIsLeftAsItWas) {
    const std::vector<std::string> composite = names("R G B A", "Composite.Combined.");
    const auto document = file({{.channels = joined({composite, cyclesChannels("ViewLayer.")})}});
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
        file({{.channels = joined({names("R G B A", "Composite.Combined."), names("R G B A", "V.Combined."),
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
    const auto maps = recognise(file({{.channels = joined({names("R G B A", "ViewLayer.Combined."),
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

/// A file beside the frame's hides a layer of the same name.
TEST_F(RecogniseTest, AttachedLayersWin) {
    image::ExrDocument document =
        file({{.name = "part", .channels = names("R G B albedo.R albedo.G albedo.B")}});
    image::LayeredImage better;
    better.width = 4;
    better.height = 2;
    better.add("", "RGB", image::Image(4, 2, 3, 0.25f), image::Storage::Float);
    document.attach("albedo", better, "better.pfm");
    const auto maps = recognise(document, {});
    EXPECT_EQ(textOf(maps.at(0), "beauty"), "RGB");
    EXPECT_EQ(maps[0].find("albedo")->evaluate(document).at(0, 0, 0), 0.25f);
    better.width = 8;
    EXPECT_THROW(document.attach("normal", better, "wide.pfm"), InputError);
}

/// A picture of 4x2 pixels with these channels, all of one value.
image::LayeredImage pictureWith(const std::vector<std::string>& channels, float value = 0.25f) {
    image::LayeredImage result;
    result.width = 4;
    result.height = 2;
    for (const std::string& name : channels)
        result.channels.push_back({name, image::Storage::Float, std::vector<float>(8, value)});
    return result;
}

TEST_F(RecogniseTest, AttachedRolesWinOverThoseOfEachRenderer) {
    image::ExrDocument document = file({{.channels = cyclesChannels("V.")}});
    document.attach("albedo", pictureWith(names("R G B")), "albedo.pfm");
    document.attach("depth", pictureWith(names("R G B")), "grey.exr");
    document.attach("motion", pictureWith(names("X Y Z W")), "motion.exr");
    document.attach("alpha", pictureWith(names("R G B A")), "colours.exr");
    document.attach("normal", pictureWith(names("N.X N.Y N.Z normal.X normal.Y normal.Z", "V.")), "all.exr");
    document.attach("diffuse", pictureWith(names("V.Combined.R V.Combined.G V.Combined.B")), "diffuse.exr");
    document.attach("n", pictureWith(names("X Y Z")), "n.exr");
    const auto maps = recognise(document, {{"cameraNormal", "n.XYZ"}});
    ASSERT_EQ(maps.size(), 1u) << "an attached beauty is no picture";
    EXPECT_EQ(textOf(maps[0], "beauty"), "V.Combined.RGB");
    EXPECT_EQ(textOf(maps[0], "albedo"), "albedo.RGB");
    EXPECT_EQ(textOf(maps[0], "depth"), "depth.R");
    EXPECT_EQ(maps[0].encoding.depthKind, DepthKind::Planar);
    EXPECT_EQ(textOf(maps[0], "motion"), "motion.XY");
    EXPECT_EQ(textOf(maps[0], "alpha"), "alpha.A");
    EXPECT_EQ(textOf(maps[0], "normal"), "normal.V.normal.XYZ") << "it has the role's name";
    EXPECT_EQ(textOf(maps[0], "diffuse"), "diffuse.V.Combined.RGB") << "the only one";
    EXPECT_EQ(textOf(recognise(document, {{"cameraNormal", "n.XYZ"}, {"specular", "albedo.RGB"}}).at(0),
                     "specular"),
              "albedo.RGB");
}

/// The encoding of a layer that is not used does not apply.
TEST_F(RecogniseTest, AnAttachedNormalIsOfTheRenderersWorld) {
    image::ExrDocument document =
        file({{.channels = joined({names("R G B", "V.Combined."), names("X Y Z", "V.Denoising Normal.")})}});
    document.attach("normal", pictureWith(names("X Y Z")), "n.exr");
    const auto maps = recognise(document, {});
    EXPECT_EQ(textOf(maps.at(0), "normal"), "normal.XYZ");
    EXPECT_EQ(maps[0].encoding.normalSpace, NormalSpace::World);
}

TEST_F(RecogniseTest, AttachedFilesThatAreNotUsedAreRefused) {
    const auto messageOf = [&](const std::string& name, const std::string& channels,
                               const Assignments& assignments = {}) -> std::string {
        image::ExrDocument document = file({{.channels = cyclesChannels("V.")}});
        document.attach(name, pictureWith(names(channels)), "a.exr");
        try {
            recognise(document, assignments);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_THAT(messageOf("colour", "R G B"),
                HasSubstr("--file colour: it is not used: 'colour' is no layer"));
    EXPECT_EQ(messageOf("colour", "R G B", {{"albedo", "colour.RGB"}}), "none");
    EXPECT_THAT(messageOf("albedo", "Y"), HasSubstr("it has no layer with three components, which 'albedo'"));
    EXPECT_THAT(messageOf("albedo", "a.R a.G a.B b.R b.G b.B"),
                HasSubstr("several of its layers fit (albedo.a.RGB, albedo.b.RGB); --map "
                          "albedo=albedo.a.RGB chooses one"));
    EXPECT_EQ(messageOf("albedo", "a.R a.G a.B b.R b.G b.B", {{"albedo", "albedo.b.RGB"}}), "none");
    EXPECT_THAT(messageOf("normal", "R G B A N.X N.Y N.Z"),
                HasSubstr("several of its layers fit (normal.XYZ, normal.N.XYZ)"))
        << "the unnamed layer may be a beauty";
    EXPECT_EQ(messageOf("depth", "R G B A depth.Z"), "none");
    EXPECT_THAT(messageOf("albedo", "R G B", {{"albedo", "V.DiffCol.RGB"}}),
                HasSubstr("--map albedo names another layer"));
    EXPECT_THAT(messageOf("beauty", "R G B"), HasSubstr("the beauty is the input itself"));
}

TEST_F(RecogniseTest, LightGroups) {
    const auto maps =
        recognise(file({{.channels = names("V.Combined.R V.Combined.G V.Combined.B V.Combined_key.R "
                                           "V.Combined_key.G V.Combined_key.B V.Combined_odd.R")}}),
                  {});
    ASSERT_EQ(maps.at(0).groups.size(), 1u);
    EXPECT_EQ(maps[0].groups[0].text(), "V.Combined_key.RGB");
}

/// The place of a layer's first channel: its part and its name there.
std::string placeOf(const LayerMap& map, std::string_view role) {
    const LayerExpression* const layer = map.find(role);
    if (!layer) return "";
    const ChannelPlace& place = layer->terms()[0].factors[0].channels[0];
    return std::to_string(place.part) + " " + place.channel;
}

TEST_F(RecogniseTest, EachViewOfBlenderIsAPicture) {
    std::vector<std::string> channels;
    for (const std::string view : {"left", "right"})
        for (const std::string layer : {"Combined", "DiffCol", "DiffDir", "Denoising Albedo"})
            for (const auto& name : names("R G B", "ViewLayer." + layer + "." + view + "."))
                channels.push_back(name);
    for (const std::string name : {"Depth.left.Z", "Depth.right.Z", "Normal.left.X", "Normal.left.Y",
                                   "Normal.left.Z", "Vector.right.X", "Vector.right.Y"})
        channels.push_back("ViewLayer." + name);
    const auto maps = recognise(file({{.channels = channels, .views = {"left", "right"}}}), {});
    ASSERT_EQ(maps.size(), 2u);
    EXPECT_EQ(maps[0].renderer, "Cycles (Blender)");
    EXPECT_EQ(maps[0].view, "left");
    EXPECT_EQ(maps[1].view, "right");
    EXPECT_EQ(maps[0].title, "ViewLayer");
    EXPECT_EQ(textOf(maps[1], "beauty"), "ViewLayer.Combined.RGB");
    EXPECT_EQ(placeOf(maps[0], "beauty"), "0 ViewLayer.Combined.left.R");
    EXPECT_EQ(placeOf(maps[1], "beauty"), "0 ViewLayer.Combined.right.R");
    EXPECT_EQ(placeOf(maps[1], "depth"), "0 ViewLayer.Depth.right.Z");
    EXPECT_EQ(placeOf(maps[1], "diffuse"), "0 ViewLayer.DiffCol.right.R");
    EXPECT_EQ(placeOf(maps[1], "normal"), "") << "the other view's normals are of other pixels";
    EXPECT_EQ(placeOf(maps[0], "motion"), "");
}

/// https://openexr.com/en/latest/MultiViewOpenEXR.html: names without a view are of the default view.
TEST_F(RecogniseTest, TheDefaultViewNeedsNoName) {
    const std::string channels =
        "R G B A Z right.R right.G right.B right.A right.Z albedo.left.R albedo.left.G albedo.left.B "
        "albedo.right.R albedo.right.G albedo.right.B normal.X normal.Y normal.Z tex.right.R tex.right.G "
        "tex.right.B";
    const auto document = file({{.channels = names(channels), .views = {"left", "right"}}});
    const auto maps = recognise(document, {});
    ASSERT_EQ(maps.size(), 2u);
    EXPECT_EQ(placeOf(maps[0], "beauty"), "0 R");
    EXPECT_EQ(placeOf(maps[1], "beauty"), "0 right.R");
    EXPECT_EQ(placeOf(maps[0], "depth"), "0 Z");
    EXPECT_EQ(placeOf(maps[1], "depth"), "0 right.Z");
    EXPECT_EQ(placeOf(maps[0], "albedo"), "0 albedo.left.R");
    EXPECT_EQ(placeOf(maps[0], "normal"), "0 normal.X");
    EXPECT_EQ(placeOf(maps[1], "normal"), "");
    // Of the view "right" alone; a file of one view is named as one without views.
    EXPECT_THROW(recognise(document, {{"albedo", "tex.RGB"}}), InputError);
    const auto one = recognise(
        file({{.channels = names("V.Combined.R V.Combined.G V.Combined.B"), .views = {"right"}}}), {});
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(placeOf(one[0], "beauty"), "0 V.Combined.R");
}

TEST_F(RecogniseTest, ANamedBeautyIsThatOfEachViewThatHasIt) {
    const std::string left = "foo.left.R foo.left.G foo.left.B ",
                      right = "foo.right.R foo.right.G foo.right.B";
    const auto both = recognise(file({{.channels = names(left + right), .views = {"left", "right"}}}),
                                {{"beauty", "foo.RGB"}});
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(placeOf(both[0], "beauty"), "0 foo.left.R");
    EXPECT_EQ(placeOf(both[1], "beauty"), "0 foo.right.R");
    const auto one =
        recognise(file({{.channels = names(left), .views = {"left", "right"}}}), {{"beauty", "foo.RGB"}});
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0].view, "left");
}

/// Parts with the attribute "view", as OpenEXR's ImfPartHelper.h splits channels. A camera is of its view.
TEST_F(RecogniseTest, PartsMayBeViews) {
    const Imath::M44f at5(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 5, 1),
        at6(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 6, 1);
    const Imath::M44f toClip(1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 1, 0, 0, -0.1f, 0);
    const auto document = file({{.name = "rgba.left",
                                 .channels = names("R G B A"),
                                 .matrices = {{"worldToCamera", at5}, {"worldToScreen", at5 * toClip}},
                                 .view = "left"},
                                {.name = "rgba.right",
                                 .channels = names("R G B A"),
                                 .matrices = {{"worldToCamera", at6}, {"worldToScreen", at6 * toClip}},
                                 .view = "right"},
                                {.name = "albedo.left", .channels = names("R G B"), .view = "left"},
                                {.name = "albedo.right", .channels = names("R G B"), .view = "right"},
                                {.name = "n_right",
                                 .channels = names("normal.right.X normal.right.Y normal.right.Z"),
                                 .view = "right"}});
    const auto maps = recognise(document, {});
    ASSERT_EQ(maps.size(), 2u);
    EXPECT_EQ(placeOf(maps[0], "beauty"), "0 R");
    EXPECT_EQ(placeOf(maps[1], "beauty"), "1 R");
    EXPECT_EQ(placeOf(maps[0], "albedo"), "2 R");
    EXPECT_EQ(placeOf(maps[1], "albedo"), "3 R");
    EXPECT_EQ(placeOf(maps[1], "normal"), "4 normal.right.X");
    EXPECT_EQ(textOf(maps[1], "albedo"), "albedo.RGB");
    EXPECT_EQ(cameraOfAttributes(document, "left")->origin, vec3(0, 0, 5));
    EXPECT_EQ(cameraOfAttributes(document, "right")->origin, vec3(0, 0, 6));
}

TEST_F(RecogniseTest, AssignmentsWin) {
    const image::ExrDocument document =
        file({{.channels = names("R G B albedo.R albedo.G albedo.B My.Tex.R My.Tex.G My.Tex.B v.X v.Y")}});
    const auto maps = recognise(document, {{"albedo", "My.Tex.RGB"},
                                           {"motion", "v.XY"},
                                           {"motion.scale", "-1,1"},
                                           {"motion.unit", "picture"},
                                           {"normal.space", "camera"}});
    EXPECT_EQ(textOf(maps.at(0), "albedo"), "My.Tex.RGB");
    EXPECT_EQ(maps[0].encoding.motionScale, vec2(-1, 1));
    EXPECT_EQ(maps[0].encoding.motionUnit, MotionUnit::Picture);
    EXPECT_EQ(maps[0].encoding.normalSpace, NormalSpace::Camera);
    EXPECT_EQ(textOf(recognise(document, {{"albedo", ""}}).at(0), "albedo"), "") << "removed";
    EXPECT_EQ(textOf(recognise(document, {{"beauty", "albedo.RGB - 0.5 * My.Tex.RGB"}}).at(0), "beauty"),
              "albedo.RGB - 0.5 * My.Tex.RGB");
}

TEST_F(RecogniseTest, FilesOfAssignmentsHoldTextsAndNumbers) {
    const auto read = [&](const std::string& text) {
        image::test::put(folder_ / "map.json", text);
        return readAssignments(folder_ / "map.json");
    };
    const Assignments expected = {
        {"albedo", "My.Tex.RGB"}, {"depth.far", "1000"}, {"motion.scale", "-1,0.5"}};
    EXPECT_EQ(read(R"({"albedo": "My.Tex.RGB", "depth.far": 1e3, "motion.scale": [-1, 0.5]})"), expected);
    for (const char* wrong : {"true", "1e300", "[1, -1e300]", R"(["a"])", "null", "{}"}) {
        try {
            read(std::string(R"({"depth.far": )") + wrong + "}");
            ADD_FAILURE() << wrong;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(),
                        HasSubstr("'depth.far' is neither a text nor a number, or is too large"));
        }
    }
}

TEST_F(RecogniseTest, WrongAssignmentsAreRefused) {
    const image::ExrDocument document = file({{.channels = names("R G B v.X v.Y")}});
    const auto messageOf = [&](const std::string& key, const std::string& value) -> std::string {
        try {
            recognise(document, {{key, value}});
        } catch (const Error& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_THAT(messageOf("colour", "RGB"), HasSubstr("'colour' is no layer; they are beauty, diffuse"));
    EXPECT_THAT(messageOf("albedo", "missing.RGB"), HasSubstr("lacks a channel of 'albedo=missing.RGB'"));
    EXPECT_THAT(messageOf("albedo", "v.XY"), HasSubstr("3 components are needed, not 2"));
    EXPECT_THAT(messageOf("albedo", "RGB * v.XY"), HasSubstr("another number of components"));
    EXPECT_THAT(messageOf("albedo", " * "), HasSubstr("is no product of layers"));
    EXPECT_THAT(messageOf("motion.scale", "1"), HasSubstr("2 numbers are needed"));
    EXPECT_THAT(messageOf("motion.scale", "1,nan"), HasSubstr("2 numbers are needed"));
    EXPECT_THAT(messageOf("depth.kind", "flat"), HasSubstr("it is 'distance' or 'planar'"));
    EXPECT_THROW(parseAssignment("albedo"), UsageError);
    try {
        recognise(file({{.channels = names("Z N.X")}}), {});
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("has no layer of colours; --map beauty=LAYER.RGB names one"));
    }
}

}  // namespace
}  // namespace limpid::shot
