// `limpid dataset`: renders many scenes with few and with many samples, for training networks.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "cli/cluster/cluster_progress.h"
#include "cli/cluster/session.h"
#include "cli/commands.h"
#include "cli/console/progress.h"
#include "cli/options/device_options.h"
#include "cli/options/long_render_options.h"
#include "denoise/methods/film/film_network.h"
#include "lab/dataset/dataset_clip.h"
#include "lab/dataset/dataset_example.h"
#include "lab/dataset/dataset_motion.h"
#include "lab/dataset/dataset_night.h"
#include "lab/dataset/dataset_pipelines.h"
#include "renderer/long/render_identity.h"
#include "scene/device/scene_data.h"
#include "scene/load/scene_files.h"
#include "scene/load/scene_source.h"
#include "scene/motion/movement.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* parametersKey = "limpid.dataset";
constexpr const char* examplesKey = "limpid.examples";

struct DatasetOptions {
    DeviceChoice device;
    std::string folder, shard = "1/1";
    std::vector<std::string> scenes;
    uint32_t rooms = 100, stillLifes = 0, perFile = 8;
    std::vector<uint32_t> sequence;  ///< the frames of each clip that are stored; empty: stills
    bool sharePipelines = false;
    std::string denoiser = "svgf";
    double moving = 0.0, night = 0.0;  ///< shares of the random clips
    uint32_t pictureHeight = 0;        ///< clips show the middle of a picture of this height; 0: all of it
    ExampleSettings example;
};

uint32_t numberFrom(uint32_t seed, std::string_view purpose, uint64_t index) {
    Hash64 hash;
    hash.add(fmt::format("{} {} {}", purpose, seed, index));
    // The hash alone keeps the order of texts that differ only in their last letter. The finalizer of
    // splitmix64 (G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014)
    // removes that order.
    uint64_t x = hash.value();
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return static_cast<uint32_t>(x ^ (x >> 31));
}

/// A checksum of the weights of the network that filters the clips, on which their past depends; empty if
/// none does.
std::string weightsOf(const std::string& denoiser) {
    if (denoiser == "svgf") return "";
    Hash64 hash;
    hash.add((denoiser == "film" ? denoise::filmNetwork() : denoise::nanoNetwork()).weights);
    return hashText(hash.value());
}

fs::path folderOf(const std::string& scene) {
    return fs::absolute(scene).parent_path();
}

/// Hash of a file; empty if it cannot be read, as a texture that is replaced by a plain colour.
std::string contentOf(const fs::path& file) {
    try {
        Hash64 hash;
        hash.addValues(readFile(file, scene::SceneFiles::maxTotalBytes));
        return hashText(hash.value());
    } catch (const InputError&) {
        return "";
    }
}

/// The files that `scene`, which has this name, was loaded from: contentOf() each, by its path from the
/// scene's folder.
json contentsOf(const std::string& name, const scene::Scene& scene) {
    json contents = json::object();
    for (const fs::path& file : scene.files) {
        // References lead to one file, but the scene's own name may be a link that is changed.
        std::error_code fault;
        const bool own = file == scene.files.front();
        const std::string path = (own ? file.filename() : fs::relative(file, folderOf(name), fault)).string();
        // JSON cannot keep any other name.
        if (!fault && validUtf8(path) == path) contents[path] = contentOf(file);
    }
    return contents;
}

/// The first difference between the parameters of two datasets, for a message.
std::string differenceOf(const json& theirs, const json& ours) {
    if (!theirs.is_object()) return "it names no parameters";
    const auto valueOf = [](const json& parameters, const std::string& key) {
        return parameters.contains(key) ? parameters.at(key).dump() : "absent";
    };
    if (valueOf(theirs, "limpid") != valueOf(ours, "limpid"))
        return fmt::format("it was made by another version of Limpid ({}, not {})", valueOf(theirs, "limpid"),
                           valueOf(ours, "limpid"));
    json keys = theirs;
    keys.update(ours);
    for (const auto& [key, unused] : keys.items()) {
        const std::string value = valueOf(theirs, key), wanted = valueOf(ours, key);
        if (value != wanted) return fmt::format("{} is {}, not {}", key, value, wanted);
    }
    return "its parameters are written otherwise";
}

class Dataset {
  public:
    explicit Dataset(const DatasetOptions& options) : o_(options) {}

    uint64_t examples() const { return uint64_t{o_.rooms} + o_.stillLifes + o_.scenes.size(); }
    uint64_t files() const { return (examples() + o_.perFile - 1) / o_.perFile; }
    fs::path file(uint64_t number) const {
        return fs::path(o_.folder) / fmt::format("examples.{:05}.safetensors", number);
    }

    /// Rooms first, then still lifes, then the named scenes.
    std::string sceneOf(uint64_t example) const {
        if (example < o_.rooms)
            return fmt::format("builtin:room-{}", numberFrom(o_.example.seed, "room", example));
        example -= o_.rooms;
        if (example < o_.stillLifes)
            return fmt::format("builtin:still-life-{}", numberFrom(o_.example.seed, "still life", example));
        return o_.scenes[example - o_.stillLifes];
    }

    /// Returns the parameters that determine the content: the same in every file of a dataset.
    json parameters() const {
        json result{{"version", 3},
                    {"limpid", LIMPID_VERSION},
                    {"seed", o_.example.seed},
                    {"rooms", o_.rooms},
                    {"still_lifes", o_.stillLifes},
                    {"scenes", o_.scenes},
                    {"per_file", o_.perFile},
                    {"width", o_.example.extent.width},
                    {"height", o_.example.extent.height},
                    {"samples", o_.example.samples},
                    {"reference_samples", o_.example.referenceSamples}};
        if (o_.sharePipelines) result["share_pipelines"] = true;  // uses up other random numbers
        if (!o_.sequence.empty()) {
            result["version"] = 5;
            result["sequence"] = o_.sequence;
            result["picture_height"] = o_.pictureHeight;
            result["denoiser"] = o_.denoiser;
            result["moving"] = o_.moving;
            result["night"] = o_.night;
            if (const std::string weights = weightsOf(o_.denoiser); !weights.empty())
                result["weights"] = weights;
        }
        return result;
    }

    /// Returns the metadata of a complete file; none if it is missing or damaged. Throws UsageError if it
    /// belongs to another dataset, or if one of its scenes has changed since.
    std::optional<std::map<std::string, std::string>> finished(uint64_t number) const {
        if (!fs::exists(file(number))) return std::nullopt;
        try {
            auto metadata = neural::readTensorFile(file(number)).metadata;
            checkParameters(number, metadata[parametersKey]);
            checkScenes(number, json::parse(metadata[examplesKey]));
            return metadata;
        } catch (const InputError& fault) {
            log::warn("{}; it is made anew", fault.what());
            return std::nullopt;
        }
    }

    void make(gpu::Device& device, scene::Tracer tracer, uint64_t number) const {
        neural::TensorFile result;
        json list = json::array();
        for (uint64_t example = number * o_.perFile;
             example < std::min(examples(), (number + 1) * o_.perFile); ++example) {
            if (ranks()) ranks()->beat();
            scene::Scene scene = scene::openScene({.scene = sceneOf(example)});
            if (!o_.sequence.empty() && !scene.rig.clips.empty()) scene::chooseClip(scene, "");
            const json varied = vary(scene, example);
            scene::SceneData data = scene::buildSceneData(scene);
            if (o_.sharePipelines) generalise(data, variesLight());
            scene::GpuScene gpuScene(device, data, {tracer, {}});
            list.push_back(o_.sequence.empty() ? addStill(device, gpuScene, scene, example, result)
                                               : addMoving(device, gpuScene, scene, data, example, result));
            list.back().update(varied);
            if (!scene.files.empty()) list.back()["files"] = contentsOf(sceneOf(example), scene);
        }
        result.metadata = {{parametersKey, parameters().dump()}, {examplesKey, list.dump()}};
        neural::writeTensorFile(file(number), result);
    }

    /// Writes the manifest of all files if all exist: the process that finishes last does this.
    bool writeManifest() const {
        for (uint64_t number = 0; number < files(); ++number) {
            if (!fs::exists(file(number))) return false;
        }
        json manifest{{"dataset", parameters()}, {"files", json::array()}};
        for (uint64_t number = 0; number < files(); ++number) {
            const auto metadata = finished(number);
            if (!metadata) return false;
            manifest["files"].push_back({{"name", file(number).filename().string()},
                                         {"bytes", fs::file_size(file(number))},
                                         {"crc32", metadata->at("crc32")},
                                         {"examples", json::parse(metadata->at(examplesKey))}});
        }
        writeTextAtomically(fs::path(o_.folder) / "manifest.json", manifest.dump(1) + "\n");
        return true;
    }

  private:
    static std::string nameOf(uint64_t example) { return fmt::format("{:06}", example); }

    void checkParameters(uint64_t number, const std::string& text) const {
        if (text == parameters().dump()) return;
        throw UsageError(fmt::format("'{}' is of another dataset: {}", file(number).string(),
                                     differenceOf(json::parse(text, nullptr, false), parameters())));
    }

    void checkScenes(uint64_t number, const json& examples) const {
        for (const json& example : examples) {
            const std::string scene = example.at("scene");
            const json files = example.value("files", json::object());
            for (const auto& [name, content] : files.items())
                if (contentOf(folderOf(scene) / name) != content)
                    throw UsageError(fmt::format("'{}': the scene '{}' has changed since: {}",
                                                 file(number).string(), scene, name));
        }
    }

    json addStill(gpu::Device& device, scene::GpuScene& gpuScene, const scene::Scene& scene, uint64_t example,
                  neural::TensorFile& result) const {
        ExampleSettings settings = o_.example;
        settings.seed = numberFrom(o_.example.seed, "samples", example);
        // Networks see both: stills, and sequences with rays through the pixels' centres.
        settings.jitter = example % 2 == 0 ? Jitter::Pixel : Jitter::Off;
        addExample(device, gpuScene, scene.cameras.front(), settings, nameOf(example), result);
        return {{"name", nameOf(example)},
                {"scene", sceneOf(example)},
                {"jitter", example % 2 == 0 ? "pixel" : "off"}};
    }

    /// From 0 to 1, for this example.
    double fraction(std::string_view purpose, uint64_t example) const {
        return numberFrom(o_.example.seed, purpose, example) / 4294967296.0;
    }

    /// The scene's camera, so that things have the size in pixels that they have in the whole picture:
    /// filters depend on it.
    scene::Camera cameraOf(const scene::Scene& scene) const {
        scene::Camera camera = scene.cameras.front();
        const float part = o_.pictureHeight == 0 ? 1.0f
                                                 : static_cast<float>(o_.example.extent.height) /
                                                       static_cast<float>(o_.pictureHeight);
        camera.verticalFov = 2.0f * std::atan(part * std::tan(0.5f * camera.verticalFov));
        camera.halfHeight *= part;
        return camera;
    }

    /// Up to four times faster or slower than usual.
    SequenceTiming timingOf(uint64_t example) const {
        return {.framesPerSecond = 30.0 * std::exp2(4.0 * fraction("speed", example) - 2.0),
                .start = 2.0 * fraction("start", example)};
    }

    /// Makes the scene of a random clip one at night, and lets things move in it, if it is this example's
    /// turn. Returns what the list of examples says of that.
    json vary(scene::Scene& scene, uint64_t example) const {
        json result = json::object();
        if (o_.sequence.empty() || example >= uint64_t{o_.rooms} + o_.stillLifes) return result;
        if (fraction("night", example) < o_.night) {
            makeNight(scene, numberFrom(o_.example.seed, "lamps at night", example));
            result["night"] = true;
        }
        if (fraction("moving", example) < o_.moving) {
            const ClipMotion motion = addMotion(scene, numberFrom(o_.example.seed, "motion", example),
                                                timingOf(example), o_.sequence);
            result["moving"] = {
                {"objects", motion.objects}, {"lights", motion.lights}, {"switched", motion.switched}};
        } else if (o_.sharePipelines && o_.moving > 0.0) {
            addStillClip(scene);
        }
        return result;
    }

    /// Through the centres, as in real time, or, with several samples, anywhere in the pixels, as renderers
    /// of films do. (Frames that are shifted would not fit their references.)
    Jitter jitterOfClip(uint64_t example) const {
        return o_.example.samples.front() > 1 && fraction("jitter", example) < 0.5 ? Jitter::Pixel
                                                                                   : Jitter::Off;
    }

    /// Whether random clips may have other lights than their scenes.
    bool variesLight() const { return o_.moving > 0.0 || o_.night > 0.0; }

    /// A camera that orbits, drives or shakes.
    json addMoving(gpu::Device& device, scene::GpuScene& gpuScene, const scene::Scene& scene,
                   const scene::SceneData& data, uint64_t example, neural::TensorFile& result) const {
        ClipSettings settings{.extent = o_.example.extent,
                              .frames = o_.sequence,
                              .samples = o_.example.samples.front(),
                              .referenceSamples = o_.example.referenceSamples,
                              .seed = numberFrom(o_.example.seed, "samples", example),
                              .jitter = jitterOfClip(example),
                              .denoiser = o_.denoiser};
        constexpr std::array paths{"orbit", "dolly", "shake"};
        const std::string path = paths[numberFrom(o_.example.seed, "path", example) % paths.size()];
        const SequenceTiming timing = timingOf(example);
        const scene::Camera camera = cameraOf(scene);
        const Sequence sequence(
            scene, data, camera,
            scene::builtinCameraPath(path, scene, camera, timing.timeOf(o_.sequence.back() + 1)), timing);
        addClip(device, gpuScene, sequence, settings, nameOf(example), result);
        return {{"name", nameOf(example)},
                {"scene", sceneOf(example)},
                {"camera_path", path},
                {"jitter", settings.jitter == Jitter::Pixel ? "pixel" : "off"},
                {"frames_per_second", timing.framesPerSecond},
                {"start", timing.start}};
    }

    const DatasetOptions& o_;
};

/// The files of the shard, or with several processes all files: each makes the next one that nobody has
/// begun.
void makeFiles(const Dataset& dataset, const Shard& shard, gpu::Device& device, scene::Tracer tracer) {
    const auto makeFile = [&](uint64_t number) {
        removeStaleTemporaries(dataset.file(number));
        if (!dataset.finished(number)) dataset.make(device, tracer, number);
    };
    if (!ranks()) {
        const uint64_t first = shard.index - 1;
        const uint64_t ofShard =
            dataset.files() > first ? (dataset.files() - first - 1) / shard.count + 1 : 0;
        Progress progress("files", ofShard);
        for (uint64_t done = 0; done < ofShard; ++done) {
            progress.show(done);
            makeFile(first + done * shard.count);
        }
        progress.show(ofShard);
        return;
    }
    ClusterProgress progress("files", dataset.files());
    cluster::SharedWork work;
    Hash64 identity;
    identity.add(dataset.parameters().dump());
    work.identity = identity.value();
    work.device = device.info().name + ", " + device.info().driver;
    for (uint64_t number = 0; number < dataset.files(); ++number) work.todo.push_back(number);
    work.make = [&](uint64_t number) {
        makeFile(number);
        return true;
    };
    work.finished = [&](const std::vector<uint64_t>&, uint64_t count) { progress.show(count); };
    const std::vector<uint64_t> made = ranks()->share(work);
    if (isFirstProcess()) log::info("{}", describePieces(made, "files"));
}

/// They come last, perhaps after hours.
void checkScenesExist(const std::vector<std::string>& scenes) {
    for (const std::string& scene : scenes) {
        if (scene.starts_with("builtin:")) continue;
        if (const auto fault = irregularity(scene)) throw InputError(scene, *fault);
    }
}

void run(const DatasetOptions& o) {
    const Shard shard = chosenShard(o.shard);
    refuseInCluster(shard.count > 1, "--shard: the processes of a cluster share out the work by themselves");
    if (!std::ranges::is_sorted(o.example.samples, std::less_equal{}) || o.example.samples.front() == 0)
        throw UsageError("--samples must be positive and strictly ascending");
    if (!o.sequence.empty()) {
        if (!std::ranges::is_sorted(o.sequence, std::less_equal{}))
            throw UsageError("the frames of --sequence must be strictly ascending");
        if (o.example.samples.size() != 1) throw UsageError("--sequence takes one number of --samples: 1");
    }
    if (o.pictureHeight > 0 && (o.sequence.empty() || o.pictureHeight < o.example.extent.height))
        throw UsageError("--picture-height goes with --sequence, and is at least --height");
    if (o.sequence.empty() && (o.denoiser != "svgf" || o.moving > 0.0 || o.night > 0.0))
        throw UsageError("--denoiser, --moving and --night go with --sequence");
    if (o.rooms + o.stillLifes == 0 && o.scenes.empty())
        throw UsageError("choose at least one room, still life or scene");
    checkPictureSize(o.example.extent);
    checkScenesExist(o.scenes);
    const Dataset dataset(o);
    makeFolder(o.folder);
    const OpenDevice device = openDevice(o.device);
    checkPictureSize(o.example.extent, *device, true);  // references are means
    const scene::Tracer tracer = chosenTracer(o.device, *device);
    makeFiles(dataset, shard, *device, tracer);
    if (!isFirstProcess()) return;
    if (dataset.writeManifest())
        log::info("{} examples in {} files, and their manifest, in {}", dataset.examples(), dataset.files(),
                  o.folder);
    else
        log::info("the shard {} is done; the others are not yet", o.shard);
}

void addClipOptions(CLI::App& command, DatasetOptions& o) {
    command
        .add_option("--sequence", o.sequence,
                    "Clips of a moving camera instead of stills: the numbers of the frames to store, "
                    "comma-separated (1,3,7,15); with one number of --samples")
        ->delimiter(',')
        ->check(CLI::Range(0, 100000));
    command
        .add_option("--picture-height", o.pictureHeight,
                    "With --sequence: clips show the middle of a picture of this height, pixels (that of the "
                    "clips)")
        ->check(CLI::Range(1, 16384));
    command
        .add_option("--denoiser", o.denoiser,
                    "With --sequence: what filters the clips, so that it is also their past: svgf, nano or "
                    "film (svgf)")
        ->check(CLI::IsMember({"svgf", "nano", "film"}));
    command
        .add_option("--moving", o.moving,
                    "With --sequence: share of the random clips in which objects or lights move, or lights "
                    "are switched (0)")
        ->check(CLI::Range(0.0, 1.0));
    command
        .add_option("--night", o.night,
                    "With --sequence: share of the random clips in which all is dim but one or two lamps (0)")
        ->check(CLI::Range(0.0, 1.0));
}

}  // namespace

void addDatasetCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "dataset", "Render many scenes with few and with many samples, to train networks on");
    auto o = std::make_shared<DatasetOptions>();
    ExampleSettings& example = o->example;
    command->add_option("-o,--output", o->folder, "Output folder")->required();
    command->add_option("--rooms", o->rooms, "Number of random rooms (100)")->check(CLI::Range(0, 1000000));
    command->add_option("--still-lifes", o->stillLifes, "Number of random still lifes (0)")
        ->check(CLI::Range(0, 1000000));
    command->add_option("--scene", o->scenes, "Additional scene: a file or a built-in one (repeatable)");
    command->add_option("--seed", example.seed,
                        "Random seed; the same seed gives the same dataset on the same device (0)");
    command->add_option("--width", example.extent.width, "Picture width, pixels (256)")
        ->check(CLI::Range(1, 16384));
    command->add_option("--height", example.extent.height, "Picture height, pixels (256)")
        ->check(CLI::Range(1, 16384));
    command
        ->add_option("--samples", example.samples,
                     "Samples per pixel of the noisy pictures, comma-separated (1,4,8,32,128)")
        ->delimiter(',');
    command
        ->add_option("--reference-samples", example.referenceSamples,
                     "Samples per pixel of the clean pictures; more is cleaner and slower (1024)")
        ->check(CLI::Range(1, 1 << 24));
    command->add_option("--per-file", o->perFile, "Examples per file (8)")->check(CLI::Range(1, 10000));
    addClipOptions(*command, *o);
    command->add_flag(
        "--share-pipelines", o->sharePipelines,
        "Trace scenes of different materials by the same pipelines; for drivers that take longer "
        "to compile one than to render an example");
    command->add_option("--shard", o->shard,
                        "I/N: write the I-th of N parts only; existing files are kept (1/1)");
    addDeviceOptions(*command, o->device);
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
