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
#include "image/png.h"
#include "image/tonemap.h"
#include "progress.h"
#include "renderer/sequence.h"
#include "renderer/still.h"
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

/// Stops, or nothing for "auto".
std::optional<float> parseExposure(const std::string& text) {
    if (text == "auto") return std::nullopt;
    const ParamValue value = parseParam("--exposure", text, ParamValue(0.0f));
    checkRange("--exposure", {"stops", 0.0f, -100.0, 100.0, "stops", ""}, value);
    return std::get<float>(value);
}

bool isExr(const fs::path& path) {
    return path.extension() == ".exr";
}

void checkOutput(const RenderOptions& o) {
    const fs::path path = FramePattern(o.output).format(0);
    if (!isExr(path) && path.extension() != ".png") {
        throw UsageError("'" + o.output + "': an output's name ends in .exr or .png");
    }
    if (!o.layers.empty() && !isExr(path)) throw UsageError("--aov needs an .exr output");
    checkWritable(path);
}

void writeOutput(const RenderOptions& o, const fs::path& path, const RenderedLayers& layers,
                 const gpu::Device& device) {
    if (isExr(path)) {
        image::LayeredImage exr = toLayeredImage(layers, parseLayers(o.layers),
                                                 o.floatExr ? image::Storage::Float : image::Storage::Half);
        exr.metadata = {{"limpid.version", LIMPID_VERSION},
                        {"limpid.scene", fs::path(o.scene.scene).filename().string()},
                        {"limpid.samples", std::to_string(layers.samples)},
                        {"limpid.seed", std::to_string(o.seed)},
                        {"limpid.device", device.info().name},
                        {"limpid.driver", device.info().driver}};
        image::writeExr(path, exr);
        return;
    }
    const image::Image beauty = beautyOf(layers);
    const float stops = parseExposure(o.exposure).value_or(image::autoExposure(beauty));
    image::writePng(path, image::toBytes(image::tonemap(beauty, stops)));
}

void writeDump(const RenderOptions& o, const fs::path& output, ProgressiveStill& still) {
    if (o.dump.empty()) return;
    for (auto& [name, picture] : still.dump(o.dump)) {
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
    RenderCounters counters;  ///< of all frames
    Timings timings;
    std::vector<gpu::PassTime> passes;  ///< of the last launch
};

void report(const RenderOptions& o, const gpu::Device& device, const Summary& s, const scene::Scene& scene,
            const scene::GpuScene& gpuScene) {
    if (s.counters.rejected > 0)
        log::warn("{} samples were NaN or infinite and count as black", s.counters.rejected);
    const double megaRays =
        static_cast<double>(s.counters.rays) * 1e-6 / std::max(s.timings.renderSeconds, 1e-9);
    if (!o.json) {
        const std::string frames = s.frames > 1 ? fmt::format("{} frames of ", s.frames) : "";
        log::info("{}{} samples of {}x{} in {:.2f} s, {:.2f} million rays per second, on {}", frames,
                  o.samples, o.width, o.height, s.timings.renderSeconds, megaRays, device.info().name);
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
                                {"samples", o.samples},
                                {"seed", o.seed},
                                {"triangles", scene.triangleCount()},
                                {"scene_bytes", gpuScene.byteCount()},
                                {"load_seconds", s.timings.loadSeconds},
                                {"upload_seconds", s.timings.uploadSeconds},
                                {"render_seconds", s.timings.renderSeconds},
                                {"rays", s.counters.rays},
                                {"million_rays_per_second", megaRays},
                                {"rejected_samples", s.counters.rejected},
                                {"last_frame_ms", passTimes},
                                {"validation_messages", device.validationMessages()}};
    fmt::print("{}\n", object.dump(2));
}

/// All frames, each written as soon as it is done.
void renderFrames(const RenderOptions& o, const RenderSettings& settings, const Sequence& sequence,
                  gpu::Device& device, scene::GpuScene& gpuScene, Summary& summary) {
    const FramePattern output(o.output);
    ProgressiveStill still(device, gpuScene, o.samples);
    Progress progress("samples", o.samples * static_cast<uint64_t>(summary.frames));
    for (int frame = 0; frame < summary.frames; ++frame) {
        const auto number = static_cast<uint64_t>(frame);
        const Clock::time_point start = Clock::now();
        still.update(sequence.moment(number, settings.extent), settings);
        while (still.launch()) progress.show(number * o.samples + still.samples());
        still.finish();
        summary.timings.renderSeconds += since(start);
        writeOutput(o, output.format(frame), still.download(), device);
        writeDump(o, output.format(frame), still);
        const RenderCounters counters = still.counters();
        summary.counters.rays += counters.rays;
        summary.counters.rejected += counters.rejected;
    }
    summary.passes = still.passTimes();
}

void render(const RenderOptions& o) {
    checkOutput(o);
    parseExposure(o.exposure);
    parseLayers(o.layers);
    const RenderSettings settings = settingsOf(o);
    const FramePattern output(o.output);
    Summary summary;
    Clock::time_point start = Clock::now();
    scene::Scene scene = loadChosenScene(o.scene);
    chooseAnimation(o.sequence, output, scene);
    const scene::Camera camera = chosenCamera(scene, o.scene.camera);
    const std::optional<scene::CameraPath> path = chosenPath(o.sequence, scene, camera);
    summary.frames = frameCount(o.sequence, output, scene, path);
    summary.timings.loadSeconds = since(start);

    start = Clock::now();
    const std::unique_ptr<gpu::Device> device = openDevice(o.device);
    scene::SceneData data = scene::buildSceneData(scene);
    scene::GpuScene gpuScene(*device, data, chosenTracer(o.device, *device));
    const Sequence sequence(scene, data, camera, path, o.sequence.timing);
    data = {};  // it is on the device now, and so are the textures
    scene.textures.clear();
    summary.timings.uploadSeconds = since(start);

    renderFrames(o, settings, sequence, *device, gpuScene, summary);
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
