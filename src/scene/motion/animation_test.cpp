// Tests animations: known values at known times, invalid files, camera paths.
#include "scene/motion/animation.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "base/log.h"
#include "scene/framing/camera_path.h"
#include "scene/load/loader_test_files.h"
#include "scene/motion/movement.h"
#include "scene/prepare/prepare.h"

namespace limpid::scene::test {
namespace {

Channel channel(AnimatedValue value, Interpolation interpolation, uint32_t components,
                std::vector<float> times, std::vector<float> values) {
    return {0, value, interpolation, components, std::move(times), std::move(values)};
}

std::vector<float> at(const Channel& c, double time) {
    std::vector<float> result;
    c.evaluate(time, result);
    return result;
}

TEST(Channels, HoldBeforeTheFirstAndAfterTheLastKey) {
    for (const Interpolation i : {Interpolation::Step, Interpolation::Linear}) {
        const Channel c = channel(AnimatedValue::Translation, i, 3, {1, 2}, {1, 2, 3, 4, 5, 6});
        EXPECT_EQ(at(c, 0.0), (std::vector<float>{1, 2, 3}));
        EXPECT_EQ(at(c, 1.0), (std::vector<float>{1, 2, 3}));
        EXPECT_EQ(at(c, 2.0), (std::vector<float>{4, 5, 6}));
        EXPECT_EQ(at(c, 9.0), (std::vector<float>{4, 5, 6}));
    }
}

TEST(Channels, StepLinearAndCubicBetweenKeys) {
    const Channel step = channel(AnimatedValue::Scale, Interpolation::Step, 3, {0, 2}, {1, 1, 1, 3, 3, 3});
    EXPECT_EQ(at(step, 1.999), (std::vector<float>{1, 1, 1}));
    const Channel linear =
        channel(AnimatedValue::Scale, Interpolation::Linear, 3, {0, 2}, {1, 1, 1, 3, 5, 9});
    EXPECT_EQ(at(linear, 0.5), (std::vector<float>{1.5f, 2, 3}));
    // A cubic whose tangents match its slope is a line; tangents are per second.
    const Channel line =
        channel(AnimatedValue::Weights, Interpolation::CubicSpline, 1, {0, 2}, {9, 1, 4, 4, 9, 9});
    EXPECT_NEAR(at(line, 0.5)[0], 3.0f, 1e-6f);
    // h(t) at t = 1/2: (v0 + v1) / 2 + span (out0 - in1) / 8.
    const Channel curve =
        channel(AnimatedValue::Weights, Interpolation::CubicSpline, 1, {1, 3}, {9, 1, 4, -2, 5, 9});
    EXPECT_NEAR(at(curve, 2.0)[0], 3.0f + 2.0f * (4.0f + 2.0f) / 8.0f, 1e-6f);
}

TEST(Channels, RotationsTakeTheShortWayAndStayUnit) {
    const float h = std::sqrt(0.5f);
    // 90 degrees about y, with the quaternion's sign flipped: half way is 45 degrees, not 135.
    const Channel c =
        channel(AnimatedValue::Rotation, Interpolation::Linear, 4, {0, 1}, {0, 0, 0, 1, 0, -h, 0, -h});
    const std::vector<float> q = at(c, 0.5);
    EXPECT_NEAR(std::abs(q[1]), std::sin(pi / 8), 1e-6f);
    EXPECT_NEAR(std::abs(q[3]), std::cos(pi / 8), 1e-6f);
    const Channel cubic = channel(AnimatedValue::Rotation, Interpolation::CubicSpline, 4, {0, 1},
                                  {0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0});
    const std::vector<float> u = at(cubic, 0.3);
    EXPECT_NEAR(u[1] * u[1] + u[3] * u[3], 1.0f, 1e-6f);
}

class AnimationFile : public FolderTest {
  protected:
    AnimationFile() { log::setLevel(log::Level::Error); }
    ~AnimationFile() override { log::setLevel(log::Level::Info); }

    /// A triangle that moves from x = 0 to x = 4 in two seconds.
    static GltfFile moving(std::vector<float> times = {0, 2},
                           std::vector<float> values = {0, 0, 0, 4, 0, 0}) {
        GltfFile file = triangle();
        const int input = file.addFloats(times, "SCALAR", 1), output = file.addFloats(values, "VEC3", 3);
        file.document["animations"] = json::array(
            {{{"name", "go"},
              {"samplers", json::array({{{"input", input}, {"output", output}}})},
              {"channels",
               json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}})}}});
        return file;
    }
    json& sampler(GltfFile& file) { return file.document["animations"][0]["samplers"][0]; }
    json& target(GltfFile& file) { return file.document["animations"][0]["channels"][0]["target"]; }

    /// A triangle skinned to one joint that the clip moves.
    GltfFile skinned() {
        GltfFile file = moving();
        json& attributes = file.primitive()["attributes"];
        attributes["JOINTS_0"] = file.addAccessor<uint8_t>(std::vector<uint8_t>(12, 0), "VEC4", 4, 5121);
        attributes["WEIGHTS_0"] = file.addFloats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
        file.document["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0}, {}])");
        file.document["scenes"][0]["nodes"] = {0, 1};
        file.document["skins"] = json::parse(R"([{"joints": [1]}])");
        target(file)["node"] = 1;
        return file;
    }
};

TEST_F(AnimationFile, ChoosesClipsByNameAndNumber) {
    Scene scene = loadScene(moving().save(folder));
    ASSERT_EQ(scene.rig.clips.size(), 1u);
    EXPECT_EQ(scene.instances[0].movement, Movement::Still);
    for (const char* choice : {"", "0", "go"}) {
        chooseClip(scene, choice);
        EXPECT_EQ(scene.instances[0].movement, Movement::Rigid);
    }
    EXPECT_EQ(evaluate(scene.rig, &scene.rig.clips[0], 0.5).toWorld[0][3].x, 1.0f);
    EXPECT_THROW(chooseClip(scene, "stop"), UsageError);
    Scene still = loadScene(triangle().save(folder));
    EXPECT_THROW(chooseClip(still, ""), UsageError);
}

TEST_F(AnimationFile, PlaysAllClipsTogether) {
    GltfFile file = moving();
    json& clips = file.document["animations"];
    const json first = clips[0];
    // The second clip moves another node and ends later; the third moves the first's node in another way.
    file.document["nodes"].push_back({{"name", "other"}});
    file.document["scenes"][0]["nodes"] = {0, 1};
    const auto add = [&](int node, const std::vector<float>& times, const std::vector<float>& values) {
        json clip = first;
        clip["name"] = "clip " + std::to_string(clips.size());
        clip["samplers"][0] = {{"input", file.addFloats(times, "SCALAR", 1)},
                               {"output", file.addFloats(values, "VEC3", 3)}};
        clip["channels"][0]["target"]["node"] = node;
        clips.push_back(clip);
    };
    add(1, {0, 3}, {0, 0, 0, 0, 3, 0});
    Scene scene = loadScene(file.save(folder));
    chooseClip(scene, "all");
    const Clip& all = scene.rig.clips[static_cast<size_t>(scene.clip)];
    EXPECT_EQ(all.name, "all");
    EXPECT_EQ(all.duration(), 3.0f);
    EXPECT_EQ(evaluate(scene.rig, &all, 1.0).toWorld[0][3].x, 2.0f);
    EXPECT_EQ(evaluate(scene.rig, &all, 1.0).toWorld[1][3].y, 1.0f);
    EXPECT_EQ(evaluate(scene.rig, &all, 3.0).toWorld[0][3].x, 4.0f) << "the shorter clip holds its last pose";
    EXPECT_EQ(scene.instances[0].movement, Movement::Rigid);
    EXPECT_EQ(playTogether(loadScene(file.save(folder)).rig).overridden, 0u);

    // The choice can be repeated, in the same scene and after loading the file again.
    const size_t clipsNow = scene.rig.clips.size();
    chooseClip(scene, clipChoice(scene));
    EXPECT_EQ(scene.rig.clips.size(), clipsNow);
    Scene again = loadScene(file.save(folder));
    EXPECT_EQ(clipChoice(again), "");
    chooseClip(again, clipChoice(scene));
    EXPECT_EQ(again.rig.clips[static_cast<size_t>(again.clip)].duration(), 3.0f);
    chooseClip(again, "1");
    EXPECT_EQ(clipChoice(again), "1");

    add(0, {0, 1}, {0, 0, 0, 0, 0, 8});
    const ClipsTogether conflict = playTogether(loadScene(file.save(folder)).rig);
    EXPECT_EQ(conflict.overridden, 1u);
    EXPECT_EQ(conflict.clip.channels.size(), 2u);
    EXPECT_EQ(evaluate(loadScene(file.save(folder)).rig, &conflict.clip, 1.0).toWorld[0][3].z, 8.0f)
        << "the last clip counts";

    // With a single clip, "all" selects it; a clip named "all" takes precedence.
    Scene one = loadScene(moving().save(folder));
    chooseClip(one, "all");
    EXPECT_EQ(one.clip, 0);
    clips[1]["name"] = "all";
    Scene named = loadScene(file.save(folder));
    chooseClip(named, "all");
    EXPECT_EQ(named.clip, 1);
}

TEST_F(AnimationFile, TellsWhatMoves) {
    GltfFile file = skinned();
    Scene scene = loadScene(file.save(folder));
    chooseClip(scene, "");
    EXPECT_EQ(scene.instances[0].movement, Movement::Deforming);
    // The node of a skinned mesh is ignored, but its joints are not.
    target(file)["node"] = 0;
    scene = loadScene(file.save(folder));
    chooseClip(scene, "");
    EXPECT_EQ(scene.instances[0].movement, Movement::Still);
}

TEST_F(AnimationFile, RefusesTimesThatAreNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    expectRefused(moving({2, 0}).save(folder), "is not later than the one before");
    expectRefused(moving({1, 1}).save(folder), "is not later than the one before");
    expectRefused(moving({0, nan}).save(folder), "negative or not finite");
    expectRefused(moving({-1, 0}).save(folder), "negative or not finite");
    expectRefused(moving({0, 2}, {0, 0, 0, nan, 0, 0}).save(folder), "not finite");
    expectRefused(moving({0, 1, 2}).save(folder), "3 times need 9");
}

TEST_F(AnimationFile, RefusesChannelsThatMultiplyTheirData) {
    std::vector<float> times(4096);
    std::iota(times.begin(), times.end(), 0.0f);
    GltfFile file = moving(times, std::vector<float>(3 * times.size()));
    json& channels = file.document["animations"][0]["channels"];
    const json channel = channels[0];
    channels = json(3, channel);
    EXPECT_EQ(loadScene(file.save(folder)).rig.clips[0].channels.size(), 3u);
    channels = json(2500, channel);
    expectRefused(file.save(folder), "too many times and values");
}

TEST_F(AnimationFile, ReadsNoMoreMatricesThanJoints) {
    const auto matrix = [](float x) {
        return std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1};
    };
    std::vector<float> both = matrix(7), replaced = matrix(2);
    both.insert(both.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 8, 0, 0, 1});
    replaced.insert(replaced.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1});
    GltfFile file = skinned();
    const int accessor = file.addFloats(both, "MAT4", 16);
    file.document["skins"][0]["inverseBindMatrices"] = accessor;
    Scene scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.rig.skins[0].inverseBind.size(), 1u);
    EXPECT_EQ(scene.rig.skins[0].inverseBind[0][3].x, 7.0f);

    // A sparse accessor may replace matrices that are not read.
    const uint16_t where[] = {1, 0};
    const int indices = file.addView(where, sizeof where);
    const int values = file.addView(replaced.data(), replaced.size() * sizeof(float));
    file.document["accessors"][static_cast<size_t>(accessor)]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.rig.skins[0].inverseBind.size(), 1u);
    EXPECT_EQ(scene.rig.skins[0].inverseBind[0][3].x, 3.0f);
}

TEST_F(AnimationFile, RefusesBrokenReferences) {
    const auto refused = [&](const std::string& fault, const std::function<void(GltfFile&)>& change) {
        GltfFile file = moving();
        change(file);
        expectRefused(file.save(folder), fault);
    };
    refused("has no input", [&](GltfFile& f) { sampler(f).erase("input"); });
    refused("has no output", [&](GltfFile& f) { sampler(f).erase("output"); });
    refused("interpolation", [&](GltfFile& f) { sampler(f)["interpolation"] = "BEZIER"; });
    refused("need 18", [&](GltfFile& f) { sampler(f)["interpolation"] = "CUBICSPLINE"; });
    refused("sampler", [&](GltfFile& f) { f.document["animations"][0]["channels"][0]["sampler"] = 1; });
    refused("node", [&](GltfFile& f) { target(f)["node"] = 7; });
    refused("without morph targets", [&](GltfFile& f) { target(f)["path"] = "weights"; });
    GltfFile file = moving();
    target(file)["path"] = "colour";
    EXPECT_TRUE(loadScene(file.save(folder)).rig.clips[0].channels.empty());
    GltfFile matrix = moving();
    matrix.document["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};
    EXPECT_TRUE(loadScene(matrix.save(folder)).rig.clips[0].channels.empty());
}

TEST_F(AnimationFile, RefusesBrokenSkinsAndTargets) {
    const auto refused = [&](const std::string& fault, const std::function<void(GltfFile&)>& change) {
        GltfFile file = skinned();
        change(file);
        expectRefused(file.save(folder), fault);
    };
    const std::vector<float> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    refused("is empty", [](GltfFile& f) { f.document["skins"][0]["joints"] = json::array(); });
    refused("has 1 matrices for 2 joints", [&](GltfFile& f) {
        f.document["skins"][0]["joints"] = {0, 1};
        f.document["skins"][0]["inverseBindMatrices"] = f.addFloats(identity, "MAT4", 16);
    });
    refused("names joint 3 of 1", [](GltfFile& f) {
        f.primitive()["attributes"]["JOINTS_0"] =
            f.addAccessor<uint8_t>({0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4, 5121);
    });
    refused("needs JOINTS_0 and WEIGHTS_0",
            [](GltfFile& f) { f.primitive()["attributes"].erase("WEIGHTS_0"); });
    refused("one element per vertex", [](GltfFile& f) {
        f.primitive()["attributes"]["WEIGHTS_0"] = f.addFloats({1, 0, 0, 0}, "VEC4", 4);
    });
    refused("has 2 elements, but the mesh has 3", [](GltfFile& f) {
        f.primitive()["targets"] = json::array({{{"POSITION", f.addFloats({0, 0, 1, 0, 0, 1}, "VEC3", 3)}}});
    });
}

TEST_F(AnimationFile, ScalesWeightsThatDoNotSumToOne) {
    GltfFile file = skinned();
    file.primitive()["attributes"]["WEIGHTS_0"] =
        file.addFloats({2, 0, 0, 0, 0.25f, 0.25f, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
    const Scene scene = loadScene(file.save(folder));
    const Deformation& d = *scene.meshes[0].deformation;
    EXPECT_EQ(d.weights[0], vec4(1, 0, 0, 0));
    EXPECT_EQ(d.weights[1], vec4(0.5f, 0.5f, 0, 0));
    EXPECT_EQ(d.weights[2], vec4(0.0f));  // no joint moves it
}

TEST_F(AnimationFile, AnimatedNodesKeepTheirMeshWhenFlattenedAtRest) {
    GltfFile file = moving({0, 2}, {0, 0, 0, 1, 1, 1});
    target(file)["path"] = "scale";
    file.document["nodes"][0]["scale"] = {0, 0, 0};
    EXPECT_EQ(loadScene(file.save(folder)).instances.size(), 1u);
}

class CameraPathFile : public FolderTest {
  protected:
    void refused(const std::string& text, const std::string& fault) {
        put(folder / "path.json", text);
        try {
            loadCameraPath(folder / "path.json");
            FAIL() << text << " was accepted";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(fault), std::string::npos) << error.what();
        }
    }
};

TEST_F(CameraPathFile, FollowsItsKeys) {
    put(folder / "path.json", R"({"keys": [
        {"time": 0, "eye": [0, 0, 5], "target": [0, 0, 0], "fov": 40},
        {"time": 1, "eye": [1, 0, 5], "target": [1, 0, 0], "fov": 40},
        {"time": 2, "eye": [2, 0, 5], "target": [2, 0, 0], "fov": 40},
        {"time": 3, "eye": [9, 9, 9], "target": [0, 0, 0], "fov": 60, "cut": true}]})");
    const CameraPath path = loadCameraPath(folder / "path.json");
    // Constant speed is preserved.
    EXPECT_NEAR(path.at(0.25).toWorld[3].x, 0.25f, 1e-5f);
    EXPECT_NEAR(path.at(1.75).toWorld[3].x, 1.75f, 1e-5f);
    EXPECT_NEAR(path.at(1.5).verticalFov, glm::radians(40.0f), 1e-6f);
    // The camera holds the last pose of the shot until the cut.
    EXPECT_EQ(path.at(2.9).toWorld[3].x, 2.0f);
    EXPECT_EQ(path.at(3.0).toWorld[3].x, 9.0f);
    EXPECT_EQ(path.at(99.0).toWorld[3].x, 9.0f);
    EXPECT_TRUE(path.cutBetween(2.9, 3.0));
    EXPECT_FALSE(path.cutBetween(3.0, 3.1));
    EXPECT_FALSE(path.cutBetween(0.0, 2.9));
}

TEST_F(CameraPathFile, HasALens) {
    put(folder / "path.json", R"({"keys": [
        {"time": 0, "eye": [0, 0, 5], "target": [0, 0, 0], "lens_diameter": 0.02},
        {"time": 1, "eye": [0, 0, 5], "target": [0, 0, 0], "lens_diameter": 0.04, "focus_distance": 3},
        {"time": 1.1, "eye": [0, 0, 5], "target": [0, 0, 0]}]})");
    const CameraPath path = loadCameraPath(folder / "path.json");
    EXPECT_EQ(path.at(0.0).lensDiameter, 0.02f);
    EXPECT_EQ(path.at(0.0).focusDistance, 5.0f);
    EXPECT_EQ(path.at(1.0).focusDistance, 3.0f);
    EXPECT_GT(path.at(0.5).lensDiameter, 0.02f);
    EXPECT_EQ(path.widest().lensDiameter, 0.04f);
    for (int i = 0; i <= 110; ++i) EXPECT_GE(path.at(0.01 * i).lensDiameter, 0.0f);
    EXPECT_EQ(path.at(2.0).lensDiameter, 0.0f);
}

TEST_F(CameraPathFile, RefusesWhatIsNoPath) {
    refused("no", "JSON");
    refused("{}", "has no \"keys\"");
    refused("[]", "is not a camera path: its JSON is array, no object");
    refused(R"({"keys": [], "fps": 30})", "has the unknown key 'fps'; known are keys");
    refused(R"({"keys": [{"time": 0, "eye": [0,0,1], "target": [0,0,0], "FOV": 40}]})",
            "keys[0]: has the unknown key 'FOV'");
    refused(R"({"keys": [{"time": 0, "eye": [0,0,1]}]})", "has no target");
    refused(R"({"keys": [{"eye": [0,0,1], "target": [0,0,0]}]})", "has no time");
    refused(R"({"keys": [{"time": 0, "eye": [0,0,1], "target": [0,0,1]}]})", "eye is on its target");
    refused(R"({"keys": [{"time": 0, "eye": [0,0,1], "target": [0,0,0], "up": [0,0,2]}]})", "along the view");
    for (const char* fov : {"0", "-20", "180"})
        refused(
            std::string(R"({"keys": [{"time": 0, "eye": [0,0,1], "target": [0,0,0], "fov": )") + fov + "}]}",
            "not between 0 and 180");
    for (const char* lens : {R"("lens_diameter": -1)", R"("focus_distance": 0)"})
        refused(std::string(R"({"keys": [{"time": 0, "eye": [0,0,1], "target": [0,0,0], )") + lens + "}]}",
                " is not ");
    refused(R"({"keys": [{"time": 1, "eye": [0,0,1], "target": [0,0,0]},
                         {"time": 1, "eye": [0,0,2], "target": [0,0,0]}]})",
            "is not later");
}

TEST(BuiltinPaths, StartAtTheCamera) {
    Scene scene;
    scene.materials.emplace_back();
    Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    scene.meshes.push_back(mesh);
    scene.instances.emplace_back();
    prepare(scene);
    for (const char* name : {"orbit", "dolly", "shake"}) {
        ASSERT_TRUE(isBuiltinCameraPath(name));
        const CameraPath path = builtinCameraPath(name, scene, scene.cameras[0], 3.0);
        EXPECT_LT(glm::distance(path.at(0.0).toWorld[3], scene.cameras[0].toWorld[3]), 1e-5f) << name;
        EXPECT_GT(glm::distance(path.at(1.0).toWorld[3], scene.cameras[0].toWorld[3]), 1e-4f) << name;
    }
    EXPECT_FALSE(isBuiltinCameraPath("file.json"));
}

}  // namespace
}  // namespace limpid::scene::test
