// Tests what users say of a file's layers: files beside the frame's (--file), and assignments (--map).
#include "base/error.h"
#include "shot/layers/recognise_fixture.h"

namespace limpid::shot {
namespace {

using test::allOf;
using test::cyclesChannels;
using test::names;
using testing::HasSubstr;

using RecogniseGivenTest = test::RecogniseTest;

/// A file beside the frame's hides a layer of the same name.
TEST_F(RecogniseGivenTest, AttachedLayersWin) {
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

TEST_F(RecogniseGivenTest, AttachedRolesWinOverThoseOfEachRenderer) {
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
TEST_F(RecogniseGivenTest, AnAttachedNormalIsOfTheRenderersWorld) {
    image::ExrDocument document =
        file({{.channels = allOf({names("R G B", "V.Combined."), names("X Y Z", "V.Denoising Normal.")})}});
    document.attach("normal", pictureWith(names("X Y Z")), "n.exr");
    const auto maps = recognise(document, {});
    EXPECT_EQ(textOf(maps.at(0), "normal"), "normal.XYZ");
    EXPECT_EQ(maps[0].encoding.normalSpace, NormalSpace::World);
}

TEST_F(RecogniseGivenTest, AttachedFilesThatAreNotUsedAreRefused) {
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

TEST_F(RecogniseGivenTest, AssignmentsWin) {
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

TEST_F(RecogniseGivenTest, FilesOfAssignmentsHoldTextsAndNumbers) {
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

TEST_F(RecogniseGivenTest, WrongAssignmentsAreRefused) {
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
