// Tests `limpid dataset`: the files do not depend on the shards, damaged ones are rendered again, and a
// furnace has its known brightness.
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "neural/tensor_file.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using neural::Tensor;
using neural::TensorFile;
using neural::valuesOf;

class CliDatasetTest : public CliTest {
  protected:
    std::string command(const std::string& folder, const std::string& more = "") const {
        return "dataset --device cpu --rooms 1 --still-lifes 1 --scene builtin:cornell --width 16 --height "
               "12 --samples 1,4 "
               "--reference-samples 8 --per-file 1 -o '" +
               path(folder) + "' " + more;
    }
    std::string file(const std::string& folder, int number) const {
        return get(folder + "/examples.0000" + std::to_string(number) + ".safetensors");
    }
};

TEST_F(CliDatasetTest, ShardsMakeWhatOneProcessMakes) {
    expect(command("whole"), 0, "3 examples in 3 files");
    expect(command("parts", "--shard 2/2"), 0, "the others are not yet");
    EXPECT_FALSE(fs::exists(path("parts/manifest.json")));
    EXPECT_FALSE(fs::exists(path("parts/examples.00000.safetensors")));
    expect(command("parts", "--shard 1/2"), 0, "their manifest");
    for (int number = 0; number < 3; ++number)
        EXPECT_EQ(file("whole", number), file("parts", number)) << number;
    EXPECT_EQ(get("whole/manifest.json"), get("parts/manifest.json"));
    const auto manifest = nlohmann::json::parse(get("whole/manifest.json"));
    ASSERT_EQ(manifest["files"].size(), 3u);
    EXPECT_EQ(manifest["files"][2]["examples"][0]["scene"], "builtin:cornell");
    for (int number = 0; number < 3; ++number) {
        const TensorFile read =
            neural::readTensorFile(path("whole/examples.0000" + std::to_string(number) + ".safetensors"));
        EXPECT_EQ(manifest["files"][static_cast<size_t>(number)]["crc32"], read.metadata.at("crc32"));
    }
}

TEST_F(CliDatasetTest, KeepsWhatIsWholeAndMakesAnewWhatIsDamaged) {
    expect(command("data"), 0, "manifest");
    const std::string first = file("data", 0), second = file("data", 1);
    const auto time = fs::last_write_time(path("data/examples.00000.safetensors"));
    put("data/examples.00001.safetensors", second.substr(0, second.size() - 100));
    fs::remove(path("data/examples.00002.safetensors"));
    expect(command("data"), 0, "made anew");
    EXPECT_EQ(file("data", 1), second);
    EXPECT_TRUE(fs::exists(path("data/examples.00002.safetensors")));
    EXPECT_EQ(file("data", 0), first);
    EXPECT_EQ(fs::last_write_time(path("data/examples.00000.safetensors")), time);
    expect(command("data", "--seed 1"), 2, "is of another dataset: seed is 0, not 1");
    EXPECT_EQ(file("data", 0), first);
}

/// Its files would be of two scenes.
TEST_F(CliDatasetTest, ASceneThatHasChangedMakesAnotherDataset) {
    const auto putScene = [&](const std::string& height, const std::string& color) {
        put("a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 " + height + " 0\nf 1 2 3\n");
        put("a.mtl", "newmtl m\nKd " + color + " 0 0\nmap_Kd a.png\n");
    };
    const std::string dataset =
        "dataset --device cpu --rooms 0 --width 8 --height 8 --samples 1 "
        "--reference-samples 2 --scene " +
        path("a.obj") + " -o '" + path("data") + "'";
    put("a.png", "no picture, so that the triangle has a plain colour");
    putScene("1", "1");
    expect(dataset, 0, "manifest");
    expect(dataset, 0, "manifest");
    const auto manifest = nlohmann::json::parse(get("data/manifest.json"));
    EXPECT_NE(manifest["dataset"]["limpid"].get<std::string>().find('.'), std::string::npos);
    for (const char* ofClips : {"denoiser", "moving", "night", "weights"})
        EXPECT_FALSE(manifest["dataset"].contains(ofClips)) << ofClips;
    const auto& files = manifest["files"][0]["examples"][0]["files"];
    EXPECT_EQ(files.size(), 3u) << files;
    EXPECT_EQ(files["a.mtl"].get<std::string>().size(), 16u) << files;
    putScene("2", "1");
    expect(dataset, 2, "has changed since: a.obj");
    putScene("1", "0.5");
    expect(dataset, 2, "has changed since: a.mtl");
    putScene("1", "1");
    expect(dataset, 0, "manifest");
    put("a.png", "another one");
    expect(dataset, 2, "has changed since: a.png");
    fs::remove(path("a.png"));
    expect(dataset, 2, "has changed since: a.png");
}

TEST_F(CliDatasetTest, SaysWhatIsWrong) {
    expect(command("data", "--shard 3/2"), 2, "--shard");
    expect(command("data", "--shard x"), 2, "--shard");
    expect("dataset --rooms 0 -o '" + path("data") + "'", 2, "choose at least one room");
    expect("dataset --samples 4,1 -o '" + path("data") + "'", 2, "ascend");
    expect("dataset --device cpu --rooms 0 --scene nothing.gltf -o '" + path("data") + "'", 3,
           "nothing.gltf");
    expect("dataset --device cpu --rooms 100 --scene nothing.gltf -o '" + path("data") + "'", 3,
           "nothing.gltf: does not exist");
    EXPECT_FALSE(fs::exists(path("data"))) << "found before the rooms are rendered";
    expect("dataset --device cpu --width 16384 --height 16384 -o '" + path("data") + "'", 2, " in an image");
    put("file", "");
    expect("dataset -o '" + path("file/data") + "'", 1, "cannot be made");
}

double meanOf(const Tensor& tensor) {
    const std::vector<float> values = valuesOf(tensor);
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Every surface emits 1 and reflects half, so 8 reflections give 1 - 1/256.
TEST_F(CliDatasetTest, AFurnaceIsAsBrightAsItMustBe) {
    expect(
        "dataset --device cpu --rooms 0 --scene builtin:furnace --width 24 --height 16 --samples 2,16 "
        "--reference-samples 64 -o '" +
            path("data") + "'",
        0, "manifest");
    const TensorFile file = neural::readTensorFile(path("data/examples.00000.safetensors"));
    const auto& tensors = file.tensors;
    const Tensor& reference = tensors.at("000000/reference/diffuse");
    EXPECT_EQ(reference.shape, (std::vector<uint64_t>{3, 16, 24}));
    EXPECT_EQ(tensors.at("000000/2/depth.variance").shape, (std::vector<uint64_t>{1, 16, 24}));
    EXPECT_EQ(tensors.size(), 2u * 10u + 2u);
    EXPECT_NEAR(meanOf(reference), 0.996, 0.01);
    EXPECT_NEAR(meanOf(tensors.at("000000/16/diffuse")), 0.996, 0.02);
    EXPECT_NEAR(meanOf(tensors.at("000000/16/albedo")), 0.5, 1e-3);
    EXPECT_EQ(meanOf(tensors.at("000000/reference/specular")), 0.0);
    // The variance of the mean falls with the number of samples.
    const double ratio =
        meanOf(tensors.at("000000/2/diffuse.variance")) / meanOf(tensors.at("000000/16/diffuse.variance"));
    EXPECT_GT(ratio, 5.0);
    EXPECT_LT(ratio, 13.0);
}

/// More in the shaders changes random numbers, but not what is seen, nor how bright it is.
TEST_F(CliDatasetTest, SharedPipelinesSeeTheSame) {
    const auto tensorsOf = [&](const std::string& name, const std::string& options) {
        expect(
            "dataset --device cpu --rooms 1 --seed 4 --width 24 --height 24 --samples 1 --sequence 1 "
            "--reference-samples 256 " +
                options + " -o '" + path(name) + "'",
            0, "manifest");
        return neural::readTensorFile(path(name + "/examples.00000.safetensors")).tensors;
    };
    const auto own = tensorsOf("own", "");
    const double mean = meanOf(own.at("000000/1/reference"));
    // The second turns on more, as for clips in which things move, of which this is none.
    for (const std::string options : {"--share-pipelines", "--share-pipelines --moving 1e-9"}) {
        const auto shared = tensorsOf("shared" + std::to_string(options.size()), options);
        for (const char* name : {"000000/1/albedo", "000000/1/normal", "000000/1/depth"})
            EXPECT_EQ(valuesOf(own.at(name)), valuesOf(shared.at(name))) << name << options;
        EXPECT_NEAR(meanOf(shared.at("000000/1/reference")), mean, 0.03 * mean) << options;
    }
}

/// Everything is white and gray, and lit alike: what SVGF accumulates, filters and composes is known.
TEST_F(CliDatasetTest, AClipHasWhatAFilterOfAccumulatedLightSees) {
    expect(
        "dataset --device cpu --rooms 0 --scene builtin:furnace --width 24 --height 16 --samples 1 "
        "--reference-samples 64 --sequence 1,3 --picture-height 32 -o '" +
            path("data") + "'",
        0, "manifest");
    const auto tensors = neural::readTensorFile(path("data/examples.00000.safetensors")).tensors;
    EXPECT_EQ(tensors.size(), 2u * (2u * 5u + 11u));
    const auto mean = [&](const std::string& name) { return meanOf(tensors.at("000000/3/" + name)); };
    EXPECT_EQ(tensors.at("000000/1/diffuse").shape, (std::vector<uint64_t>{4, 16, 24}));
    EXPECT_EQ(tensors.at("000000/1/camera").shape, (std::vector<uint64_t>{4, 3}));
    const std::vector<float> camera = valuesOf(tensors.at("000000/1/camera"));
    EXPECT_NEAR(std::hypot(camera[3], camera[4], camera[5]), 0.5 * std::tan(0.5),
                1e-4);                            // upwards, half as far
    EXPECT_NEAR(mean("reference"), 1.996, 0.01);  // of which 1 is emission
    EXPECT_NEAR(mean("reference2"), 1.996, 0.01);
    EXPECT_NE(valuesOf(tensors.at("000000/3/reference")), valuesOf(tensors.at("000000/3/reference2")));
    EXPECT_NEAR(mean("albedo"), 0.5, 1e-3);
    // The fourth channel is 1.
    EXPECT_NEAR(mean("svgf"), (3.0 * 1.996 + 1.0) / 4.0, 0.02);
    EXPECT_GT(mean("diffuse.frames"), 2.0);
    EXPECT_EQ(mean("specular.past"), 0.0);
    EXPECT_EQ(tensors.at("000000/1/diffuse.svgf").shape, (std::vector<uint64_t>{4, 16, 24}));
    EXPECT_EQ(mean("specular.svgf"), 0.0);
    const auto manifest = nlohmann::json::parse(get("data/manifest.json"));
    EXPECT_EQ(manifest["dataset"]["sequence"], (std::vector<int>{1, 3}));
    expect(
        "dataset --device cpu --rooms 0 --scene builtin:furnace --width 24 --height 16 --samples 1 "
        "--reference-samples 64 --sequence 1,3 --picture-height 32 --share-pipelines -o '" +
            path("data") + "'",
        2, "share_pipelines is absent, not true");
    expect("dataset --sequence 3,1 --samples 1 -o '" + path("x") + "'", 2, "ascending");
    expect("dataset --sequence 1,3 -o '" + path("x") + "'", 2, "one number of --samples");
    expect("dataset --picture-height 512 -o '" + path("x") + "'", 2, "--picture-height");
}

/// Small clips of a random room and a named scene.
class CliClipsTest : public CliTest {
  protected:
    std::string command(const std::string& folder, const std::string& more = "") const {
        return "dataset --device cpu --rooms 1 --seed 6 --scene builtin:cornell --width 32 --height 32 "
               "--samples 1 --sequence 1,3 --reference-samples 16 -o '" +
               path(folder) + "' " + more;
    }
    std::map<std::string, Tensor> made(const std::string& folder, const std::string& more = "") const {
        expect(command(folder, more), 0, "manifest");
        return neural::readTensorFile(path(folder + "/examples.00000.safetensors")).tensors;
    }
    nlohmann::json manifest(const std::string& folder) const {
        return nlohmann::json::parse(get(folder + "/manifest.json"));
    }
};

TEST_F(CliClipsTest, ThingsMoveInRandomScenesButTheCameraAsBefore) {
    const auto still = made("still"), moving = made("moving", "--moving 1");
    const auto same = [&](const std::string& name) {
        return valuesOf(still.at(name)) == valuesOf(moving.at(name));
    };
    EXPECT_TRUE(same("000000/3/camera"));
    EXPECT_FALSE(same("000000/3/depth"));
    EXPECT_TRUE(same("000001/3/depth")) << "cornell has been named";
    const auto before = manifest("still"), after = manifest("moving");
    EXPECT_EQ(before["dataset"]["moving"], 0.0);
    EXPECT_EQ(before["dataset"]["night"], 0.0);
    EXPECT_EQ(before["dataset"]["denoiser"], "svgf");
    EXPECT_FALSE(before["dataset"].contains("weights"));
    EXPECT_EQ(after["dataset"]["moving"], 1.0);
    const auto& examples = after["files"][0]["examples"];
    EXPECT_GT(examples[0]["moving"]["objects"], 0);
    EXPECT_FALSE(examples[1].contains("moving"));
    expect(command("still", "--moving 1"), 2, "moving is 0.0, not 1.0");
}

TEST_F(CliClipsTest, NightIsDarkAndShowsTheSame) {
    const auto day = made("day"), night = made("night", "--night 1");
    EXPECT_EQ(valuesOf(day.at("000000/3/depth")), valuesOf(night.at("000000/3/depth")));
    EXPECT_LT(meanOf(night.at("000000/3/reference")), 0.8 * meanOf(day.at("000000/3/reference")));
    EXPECT_GT(meanOf(night.at("000000/3/reference")), 0.0);
    EXPECT_EQ(valuesOf(day.at("000001/3/reference")), valuesOf(night.at("000001/3/reference")));
    EXPECT_EQ(manifest("night")["dataset"]["night"], 1.0);
    EXPECT_EQ(manifest("night")["files"][0]["examples"][0]["night"], true);
}

/// Both accumulate the same light, but each has its own past, which SVGF's last level mixes in.
TEST_F(CliClipsTest, NanoSeesWhatItHasMadeItself) {
    const auto svgf = made("svgf"), nano = made("nano", "--denoiser nano");
    const auto same = [&](const std::string& name) {
        return valuesOf(svgf.at(name)) == valuesOf(nano.at(name));
    };
    EXPECT_EQ(svgf.size(), nano.size());
    for (const auto& [name, unused] : svgf) {
        const bool isOwn = name.ends_with(".past") || name.ends_with("svgf");
        EXPECT_TRUE(isOwn || same(name)) << name;
    }
    EXPECT_TRUE(svgf.contains("000000/3/motion") && svgf.contains("000000/3/diffuse.frames"));
    EXPECT_FALSE(same("000000/3/diffuse.past"));
    EXPECT_FALSE(same("000000/3/svgf"));
    const double mean = meanOf(svgf.at("000000/3/diffuse.past"));
    EXPECT_NEAR(meanOf(nano.at("000000/3/diffuse.past")), mean, 0.2 * mean);
    const auto dataset = manifest("nano")["dataset"];
    EXPECT_EQ(dataset["denoiser"], "nano");
    EXPECT_EQ(dataset["weights"].get<std::string>().size(), 16u);
}

TEST_F(CliClipsTest, SayWhatIsWrong) {
    expect(command("x", "--moving 1.5"), 2, "--moving");
    expect(command("x", "--night -0.1"), 2, "--night");
    expect(command("x", "--denoiser kpcn"), 2, "--denoiser");
    for (const char* option : {"--moving 0.5", "--night 0.5", "--denoiser nano"})
        expect("dataset --rooms 1 " + std::string(option) + " -o '" + path("x") + "'", 2,
               "go with --sequence");
    EXPECT_FALSE(fs::exists(path("x")));
}

}  // namespace
}  // namespace limpid
