// limpid render: a scene to an image file.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "commands.h"
#include "device_options.h"
#include "image/exr.h"
#include "long_render_options.h"
#include "picture_output.h"
#include "progress.h"
#include "renderer/long_render.h"
#include "renderer/render_identity.h"
#include "renderer/sequence.h"
#include "scene_options.h"
#include "sequence_options.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct RenderOptions {
    SceneChoice scene;
    SequenceChoice sequence;
    DeviceChoice device;
    LongRenderChoice longRender;
    std::string output;
    uint32_t width = 1280, height = 720;
    uint64_t samples = 64;
    uint32_t samplesPerLaunch = 1;
    uint32_t seed = 0;
    int maxDepth = -1;  // -1: the parameter's own default
    std::string pipeline = "path", sampler = "pcg", jitter = "pixel", exposure = "auto", layers, dump;
    std::vector<std::string> assignments;
    bool floatExr = false, json = false;
};

struct Timings {
    double loadSeconds = 0.0, uploadSeconds = 0.0, renderSeconds = 0.0;
};

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void addOptions(CLI::App& command, RenderOptions& o) {
    addSceneOptions(command, o.scene);
    addSequenceOptions(command, o.sequence);
    command
        .add_option("-o,--output", o.output,
                    "Output: .exr (linear, layers) or .png (tone-mapped); frame.%04d.exr for several frames")
        ->required();
    command.add_option("--width", o.width, "Pixels (1280)")->check(CLI::Range(1, 65535));
    command.add_option("--height", o.height, "Pixels (720)")->check(CLI::Range(1, 65535));
    command.add_option("--spp", o.samples, "Samples per pixel (64)")->check(CLI::Range(1, 1 << 24));
    command
        .add_option("--samples-per-launch", o.samplesPerLaunch,
                    "Of these, so many in one launch (1); at most 4 on a CPU")
        ->check(CLI::Range(1, 4096));
    command.add_option("--max-depth", o.maxDepth, "Bounces (8); the same as --set pathtrace.max_depth")
        ->check(CLI::Range(0, 1024));
    command.add_option("--seed", o.seed, "Another seed, other noise (0)");
    command.add_option("--sampler", o.sampler, "Random numbers: pcg (default) or tea")
        ->check(CLI::IsMember({"pcg", "tea"}));
    command.add_option("--jitter", o.jitter, "Where in its pixel a ray goes: pixel (default), frame or off")
        ->check(CLI::IsMember({"pixel", "frame", "off"}));
    command.add_option("--pipeline", o.pipeline, "path")->check(CLI::IsMember({"path"}));
    command.add_option("--set", o.assignments, "A parameter: group.name=value; 'limpid info' lists them");
    command.add_option("--exposure", o.exposure, "Of a PNG: stops, or 'auto' (default)");
    command.add_option("--aov", o.layers, "EXR layers besides beauty, by commas, or 'all'");
    command.add_option("--dump", o.dump, "Write the images of this pass beside the output");
    command.add_flag("--float", o.floatExr, "32-bit colours in the EXR; default 16-bit");
    command.add_flag("--json", o.json, "One JSON object about the run on stdout");
    addLongRenderOptions(command, o.longRender);
    addDeviceOptions(command, o.device);
}

RenderSettings settingsOf(const RenderOptions& o) {
    RenderSettings settings;
    settings.extent = {o.width, o.height};
    settings.seed = o.seed;
    settings.samplesPerLaunch = o.samplesPerLaunch;
    settings.jitter = o.jitter == "pixel" ? Jitter::Pixel : o.jitter == "frame" ? Jitter::Frame : Jitter::Off;
    settings.layers = !o.layers.empty();
    settings.pathtrace.samplerTea = o.sampler == "tea";
    if (o.maxDepth >= 0) settings.pathtrace.maxDepth = o.maxDepth;
    for (const std::string& text : o.assignments) {
        const Assignment a = parseAssignment(text);
        const auto& table = pathtraceParams();
        if (a.group != table.group() || !table.set(settings.pathtrace, a.name, a.value)) {
            throw UsageError("there is no parameter '" + a.group + "." + a.name +
                             "'; 'limpid info' lists them");
        }
    }
    return settings;
}

/// A shard of a still is no picture yet.
bool writesSums(const RenderOptions& o) {
    return !FramePattern(o.output).numbered() && chosenShard(o.longRender).count > 1;
}

void checkOutput(const RenderOptions& o) {
    const fs::path path = FramePattern(o.output).format(0);
    const bool sums = path.extension() == ".sums";
    if (sums != writesSums(o)) {
        throw UsageError(
            "'" + o.output +
            (sums ? "': only a shard of a still is written to a .sums file"
                  : "': the name of a still's shard ends in .sums; 'limpid merge' makes the picture"));
    }
    if (sums) return checkWritable(path);
    checkPictureOutput(path, !o.layers.empty());
}

/// In the order of layerNames(), each once.
std::vector<std::string> chosenLayers(const RenderOptions& o) {
    const std::vector<std::string> chosen = parseLayers(o.layers);
    std::vector<std::string> layers;
    for (const std::string& name : layerNames()) {
        if (std::find(chosen.begin(), chosen.end(), name) != chosen.end()) layers.push_back(name);
    }
    return layers;
}

void writeDump(const RenderOptions& o, const fs::path& output, BlockRenderer& renderer) {
    if (o.dump.empty()) return;
    if (!renderer.hasLaunched()) return log::warn("nothing was rendered: there is nothing to dump");
    for (auto& [name, picture] : renderer.dump(o.dump)) {
        std::string flat = name;
        std::replace(flat.begin(), flat.end(), '/', '.');
        fs::path path(output);
        path.replace_extension("." + flat + ".exr");
        image::LayeredImage exr;
        exr.width = picture.width;
        exr.height = picture.height;
        exr.add("", std::string_view("RGBA").substr(0, picture.components), picture, image::Storage::Float);
        image::writeExr(path, exr);
        log::info("wrote {}", path.string());
    }
}

/// What was rendered, for the last line or the JSON object.
struct Summary {
    int frames = 0;
    uint64_t framesFinished = 0;  ///< with those of earlier runs
    uint64_t framesToDo = 0;      ///< of the shard
    uint64_t blocksFinished = 0;
    uint64_t samples = 0;  ///< of the last picture or file of sums, per pixel
    bool complete = false;
    SampleCounts counts;  ///< of this run
    Timings timings;
    std::vector<gpu::PassTime> passes;  ///< of the last launch
};

void warnOfLosses(const SampleCounts& counts) {
    if (counts.rejected > 0) log::warn("{} samples were NaN or infinite and count as black", counts.rejected);
    if (counts.clamped > 0) log::warn("{} means were beyond +-1e12 and were clamped", counts.clamped);
}

void warnOfRest(const RenderOptions& o, const Summary& s) {
    if (s.framesToDo == 0 || (s.complete && s.samples == 0 && writesSums(o)))
        log::warn("shard {} is empty: there are fewer parts than shards", o.longRender.shard);
    if (s.complete) return;
    const std::string rest = o.longRender.checkpoint.empty() ? "" : "; --resume makes the rest";
    if (s.frames > 1) {
        log::warn("time is up: {} of {} frames are finished{}", s.framesFinished, s.framesToDo, rest);
    } else {
        log::warn("time is up: the picture has {} of {} samples{}", s.samples, o.samples, rest);
    }
}

void warnOfNoProgress(const RenderOptions& o, const Summary& s) {
    if (s.complete || s.blocksFinished > 0 || (o.longRender.checkpoint.empty() && !writesSums(o))) return;
    log::warn("not one block of {} samples was finished in that time, and only whole blocks are kept",
              std::min<uint64_t>(o.samples, blockSamplesFor(o.samples)));
}

void report(const RenderOptions& o, const gpu::Device& device, const Summary& s, const scene::Scene& scene,
            const scene::GpuScene& gpuScene) {
    warnOfLosses(s.counts);
    warnOfRest(o, s);
    warnOfNoProgress(o, s);
    const double megaRays =
        static_cast<double>(s.counts.rays) * 1e-6 / std::max(s.timings.renderSeconds, 1e-9);
    if (!o.json) {
        const std::string frames = s.frames > 1 ? fmt::format("{} frames of ", s.framesFinished) : "";
        log::info("{}{} samples of {}x{} in {:.2f} s, {:.2f} million rays per second, on {}", frames,
                  s.samples, o.width, o.height, s.timings.renderSeconds, megaRays, device.info().name);
        return;
    }
    nlohmann::json passTimes = nlohmann::json::object();
    for (const gpu::PassTime& pass : s.passes) {
        const double before = passTimes.value(pass.name, 0.0);  // a pass may be dispatched several times
        passTimes[pass.name] = before + pass.milliseconds;
    }
    const nlohmann::json object{{"output", o.output},
                                {"device", device.info().name},
                                {"tracer", scene::toString(gpuScene.tracer())},
                                {"width", o.width},
                                {"height", o.height},
                                {"frames", s.frames},
                                {"frames_finished", s.framesFinished},
                                {"samples", s.samples},
                                {"complete", s.complete},
                                {"seed", o.seed},
                                {"triangles", scene.triangleCount()},
                                {"scene_bytes", gpuScene.byteCount()},
                                {"load_seconds", s.timings.loadSeconds},
                                {"upload_seconds", s.timings.uploadSeconds},
                                {"render_seconds", s.timings.renderSeconds},
                                {"rays", s.counts.rays},
                                {"million_rays_per_second", megaRays},
                                {"rejected_samples", s.counts.rejected},
                                {"last_frame_ms", passTimes},
                                {"validation_messages", device.validationMessages()}};
    fmt::print("{}\n", object.dump(2));
}

/// What files of sums and pictures say about this render.
AccumulationHeader headerOf(const RenderOptions& o, const RenderSettings& settings, const Sequence& sequence,
                            uint64_t frames, uint64_t sceneContent, const gpu::Device& device,
                            scene::Tracer tracer) {
    AccumulationHeader header;
    const RenderIdentity identity{.version = LIMPID_VERSION,
                                  .sceneName = fs::path(o.scene.scene).filename().string(),
                                  .scene = sceneContent,
                                  .cameras = cameraHash(sequence, frames, settings.extent)};
    header.identity = identityOf(identity, settings, o.sequence.timing);
    header.extent = settings.extent;
    header.plan = planBlocks(device, settings, o.samples);
    header.layers = chosenLayers(o);
    header.frames = frames;
    header.shard = chosenShard(o.longRender);
    header.frame = frames > 1 ? header.shard.at(0) : 0;
    header.device = validUtf8(device.info().name);
    header.driver = validUtf8(device.info().driver);
    header.tracer = scene::toString(tracer);
    header.floatColors = o.floatExr;
    header.exposure = o.exposure;
    return header;
}

/// All frames, each written as soon as it is done.
void renderFrames(const RenderOptions& o, const RenderSettings& settings, const AccumulationHeader& header,
                  const Sequence& sequence, gpu::Device& device, scene::GpuScene& gpuScene,
                  Clock::time_point started, Summary& summary) {
    const FramePattern output(o.output);
    BlockRenderer renderer(device, gpuScene, settings, header.plan);
    LongRender job(renderer, sequence, header);
    if (o.longRender.timeLimit > 0.0) {
        const std::chrono::duration<double> limit(o.longRender.timeLimit);
        job.setDeadline(started + std::chrono::duration_cast<Clock::duration>(limit));
    }
    if (!o.longRender.checkpoint.empty())
        job.setCheckpoint(Checkpoint(o.longRender.checkpoint), o.longRender.resume);
    Progress progress("samples", job.samplesToDo());
    const auto file = [&](uint64_t frame) { return output.format(static_cast<int>(frame)); };
    const auto finish = [&](uint64_t frame, const FrameSums& sums) {
        summary.samples = sums.samples();
        if (o.longRender.resume) removeStaleTemporaries(file(frame));
        if (writesSums(o)) {
            writeAccumulation(file(frame), job.header(), sums);
        } else {
            writePicture(file(frame), job.header(), frame, sums);
        }
        writeDump(o, file(frame), renderer);
    };
    summary.complete = job.run({.progress = [&](uint64_t samples) { progress.show(samples); },
                                .finish = finish,
                                .isThere = [&](uint64_t frame) { return fs::exists(file(frame)); }});
    summary.blocksFinished = job.blocksFinished();
    summary.framesFinished = job.framesFinished();
    summary.framesToDo = job.framesToDo();
    summary.timings.renderSeconds = job.renderSeconds();
    summary.counts = renderer.counts();
    if (renderer.hasLaunched()) summary.passes = renderer.passTimes();
}

void checkOptions(const RenderOptions& o) {
    checkLongRender(o.longRender);
    checkOutput(o);
    parseExposure(o.exposure);
    parseLayers(o.layers);
}

void render(const RenderOptions& o) {
    checkOptions(o);
    const RenderSettings settings = settingsOf(o);
    const FramePattern output(o.output);
    Summary summary;
    const Clock::time_point started = Clock::now();
    scene::Scene scene = loadChosenScene(o.scene);
    chooseAnimation(o.sequence, output, scene);
    const scene::Camera camera = chosenCamera(scene, o.scene.camera);
    const std::optional<scene::CameraPath> path = chosenPath(o.sequence, scene, camera);
    summary.frames = frameCount(o.sequence, output, scene, path);
    if (summary.frames == 1 && output.numbered() && chosenShard(o.longRender).count > 1)
        throw UsageError("--shard: the sequence has one frame only, which is a still: name a .sums file");
    summary.timings.loadSeconds = since(started);

    const Clock::time_point uploadStart = Clock::now();
    const std::unique_ptr<gpu::Device> device = openDevice(o.device);
    scene::SceneData data = scene::buildSceneData(scene);
    scene::GpuScene gpuScene(*device, data, {chosenTracer(o.device, *device), {}});
    const Sequence sequence(scene, data, camera, path, o.sequence.timing);
    const AccumulationHeader header = headerOf(o, settings, sequence, static_cast<uint64_t>(summary.frames),
                                               sceneHash(scene, data), *device, gpuScene.tracer());
    data = {};  // it is on the device now, and so are the textures
    scene.textures.clear();
    summary.timings.uploadSeconds = since(uploadStart);

    renderFrames(o, settings, header, sequence, *device, gpuScene, started, summary);
    report(o, *device, summary, scene, gpuScene);
    if (device->validationMessages() > 0) {
        throw Error(fmt::format("the validation layer reported {} messages", device->validationMessages()));
    }
}

}  // namespace

void addRenderCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Path-trace a scene to an EXR or PNG file");
    auto options = std::make_shared<RenderOptions>();
    addOptions(*command, *options);
    command->callback([options] { render(*options); });
}

}  // namespace limpid::cli
