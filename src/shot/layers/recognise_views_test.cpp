// Tests that the views of stereo and multi-view files are told apart.
#include "base/error.h"
#include "shot/camera/camera_attributes.h"
#include "shot/layers/recognise_fixture.h"

namespace limpid::shot {
namespace {

using test::names;

using RecogniseViewsTest = test::RecogniseTest;

/// The place of a layer's first channel: its part and its name there.
std::string placeOf(const LayerMap& map, std::string_view role) {
    const LayerExpression* const layer = map.find(role);
    if (!layer) return "";
    const ChannelPlace& place = layer->terms()[0].factors[0].channels[0];
    return std::to_string(place.part) + " " + place.channel;
}

TEST_F(RecogniseViewsTest, EachViewOfBlenderIsAPicture) {
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
TEST_F(RecogniseViewsTest, TheDefaultViewNeedsNoName) {
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

TEST_F(RecogniseViewsTest, ANamedBeautyIsThatOfEachViewThatHasIt) {
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
TEST_F(RecogniseViewsTest, PartsMayBeViews) {
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

}  // namespace
}  // namespace limpid::shot
