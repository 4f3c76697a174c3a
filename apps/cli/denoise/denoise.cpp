// `limpid denoise`: denoises frames of any renderer.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "base/log.h"
#include "cli/commands.h"
#include "cli/denoise/denoise_shot.h"
#include "cli/denoise/explain_shot.h"
#include "cli/json_text.h"
#include "cli/options/device_options.h"
#include "cli/options/former_options.h"
#include "cli/options/pipeline_options.h"
#include "cli/render/picture_output.h"
#include "renderer/frame/network_file.h"
#include "renderer/frame/parameters.h"
#include "renderer/frame/presets.h"

namespace limpid::cli {
namespace {

struct DenoiseOptions {
    std::string input, output, denoiser, exposure = "auto", dump, weights, preset;
    std::string mapFile, cameras, frames, shard, cuts = "auto", motion = "auto", onError = "stop";
    std::vector<std::string> assignments, map, files;
    DeviceChoice device;
    float strength = 1.0f;
    shot::GltfTiming cameraTiming;
    bool json = false, explain = false, bidirectional = false, resume = false;
};

/// Returns the denoiser of --denoiser, else of --preset, else svgf.
const denoise::Denoiser& chosenDenoiser(const DenoiseOptions& o) {
    const std::string name = o.denoiser.empty() && o.preset.empty() ? "svgf" : o.denoiser;
    const Pipeline pipeline = pipelineFor(o.preset, {.integrator = {}, .denoiser = name}, {});
    if (pipeline.denoiser) return *pipeline.denoiser;
    throw UsageError("--denoiser is missing; it is one of " + listOfDenoisers());
}

denoise::DenoiserSettings settingsOf(const DenoiseOptions& o) {
    RenderSettings settings;
    applyPreset(settings, o.preset);
    for (const std::string& text : o.assignments) assign(settings, text);
    return settings.denoisers;
}

uint64_t hashOfFile(const std::string& path) {
    Hash64 hash;
    hash.add(readFile(path));
    return hash.value();
}

/// Parses "10-20" or "7".
std::pair<int, int> parseRange(const std::string& text) {
    int first = 0, last = 0;
    const char* const end = text.data() + text.size();
    const auto a = std::from_chars(text.data(), end, first);
    bool good = a.ec == std::errc{} && first >= 0;
    last = first;
    if (good && a.ptr != end) {
        const auto b = std::from_chars(a.ptr + 1, end, last);
        good = *a.ptr == '-' && b.ec == std::errc{} && b.ptr == end && last >= first;
    }
    if (!good) throw UsageError(fmt::format("--frames {}: an example is 10-20", text));
    return {first, last};
}

/// Returns the frames to denoise, or -1 for a single file.
std::vector<int> framesOf(const DenoiseOptions& o, const FramePattern& input) {
    if (!input.numbered()) {
        if (!o.frames.empty()) throw UsageError("--frames: the input's name holds no number");
        return {-1};
    }
    std::vector<int> frames = o.onError == "skip" ? input.existingFrames() : std::vector<int>{};
    if (o.frames.empty()) return frames.empty() ? input.wholeSequence() : frames;
    if (frames.empty()) frames = input.existingFrames();
    const auto [first, last] = parseRange(o.frames);
    std::erase_if(frames, [&, a = first, b = last](int frame) { return frame < a || frame > b; });
    for (size_t i = 0; o.onError != "skip" && i + 1 < frames.size(); ++i)
        if (frames[i + 1] != frames[i] + 1)
            throw InputError(input.text(), fmt::format("frame {} is missing", frames[i] + 1));
    if (frames.empty()) throw InputError(input.text(), fmt::format("there are no frames {}", o.frames));
    if (o.onError != "skip" && (frames.front() != first || frames.back() != last))
        throw InputError(input.text(),
                         fmt::format("frame {} is missing", frames.front() != first ? first : last));
    return frames;
}

/// Chooses the job's frames that are written: all, or those of "2/4", the second of four parts.
void chooseShard(const std::string& text, ShotJob& job) {
    size_t part = 1, parts = 1;
    if (!text.empty()) {
        const char* const end = text.data() + text.size();
        const auto a = std::from_chars(text.data(), end, part);
        const auto b = a.ptr < end && *a.ptr == '/' ? std::from_chars(a.ptr + 1, end, parts) : a;
        if (a.ec != std::errc{} || b.ec != std::errc{} || b.ptr != end || b.ptr == a.ptr || part < 1 ||
            part > parts)
            throw UsageError(fmt::format("--shard {}: an example is 2/4, the second of four parts", text));
    }
    const size_t count = job.frames.size();
    job.firstWritten = count * (part - 1) / parts;
    job.endWritten = count * part / parts;
}

/// What the result depends on besides the input.
std::string settingsText(const DenoiseOptions& o) {
    const std::string mapFile = o.mapFile.empty() ? "" : hashText(hashOfFile(o.mapFile));
    const std::string weights = o.weights.empty() ? "" : hashText(hashOfFile(o.weights));
    return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", LIMPID_VERSION, o.denoiser, o.preset, weights,
                       fmt::join(o.assignments, " "), fmt::join(o.map, " "), fmt::join(o.files, " "), mapFile,
                       o.cuts, o.motion, o.bidirectional, o.strength);
}

/// Parses "auto", "none" or "12,40".
std::optional<std::vector<int>> parseCuts(const std::string& text) {
    if (text == "auto") return std::nullopt;
    std::vector<int> cuts;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (text != "none" && at < end) {
        int frame = 0;
        const auto [next, error] = std::from_chars(at, end, frame);
        if (error != std::errc{} || (next != end && *next != ','))
            throw UsageError(fmt::format("--cuts {}: it is auto, none, or frames separated by commas", text));
        cuts.push_back(frame);
        at = next + 1;
    }
    return cuts;
}

shot::Assignments mapOf(const DenoiseOptions& o) {
    shot::Assignments result;
    if (!o.mapFile.empty()) result = shot::readAssignments(o.mapFile);
    for (const std::string& text : o.map) result.push_back(shot::parseAssignment(text));
    return result;
}

std::vector<std::pair<std::string, FramePattern>> filesOf(const DenoiseOptions& o, bool numbered) {
    std::vector<std::pair<std::string, FramePattern>> files;
    for (const std::string& text : o.files) {
        const size_t equals = text.find('=');
        if (equals == 0 || equals == std::string::npos)
            throw UsageError(fmt::format("--file {}: an example is albedo=albedo.%04d.pfm", text));
        files.emplace_back(text.substr(0, equals), FramePattern(text.substr(equals + 1)));
        if (files.back().second.numbered() && !numbered)
            throw UsageError(fmt::format("--file {}: the input's name holds no number", text));
    }
    return files;
}

ShotJob jobOf(const DenoiseOptions& o) {
    ShotJob job{.input = FramePattern(o.input),
                .output = FramePattern(o.explain ? o.input : o.output),
                .exposure = o.exposure,
                .dump = o.dump};
    if (job.input.numbered() != job.output.numbered())
        throw UsageError("'" + o.output + "': the output's name holds a number if the input's does");
    job.options.method = &chosenDenoiser(o);
    job.options.settings = settingsOf(o);
    job.options.keepsAntialiasing =
        !o.preset.empty() || std::any_of(o.assignments.begin(), o.assignments.end(),
                                         [](const std::string& text) { return text.starts_with("taa."); });
    job.load.assignments = mapOf(o);
    job.load.network = job.options.method->network;
    job.load.files = filesOf(o, job.input.numbered());
    if (o.motion != "auto" && o.motion != "none") throw UsageError("--motion is 'auto' or 'none'");
    job.load.searchMotion = o.motion == "auto";
    if (o.onError != "stop" && o.onError != "skip") throw UsageError("--on-error is 'stop' or 'skip'");
    job.skipUnreadable = o.onError == "skip";
    job.strength = o.strength;
    job.bidirectional = o.bidirectional && job.input.numbered();
    if (job.bidirectional && (job.options.method->network || job.options.method->name == "bilateral"))
        throw UsageError("--bidirectional: --denoiser " + std::string(job.options.method->name) +
                         " has no history");
    const auto cuts = parseCuts(o.cuts);
    job.cuts = cuts ? Cuts::Given : Cuts::Found;
    job.cutFrames = cuts.value_or(std::vector<int>{});
    job.frames = framesOf(o, job.input);
    job.load.sequence = job.frames.size() > 1;
    chooseShard(o.shard, job);
    job.settingsText = settingsText(o);
    job.resume = o.resume;
    const bool exr = isExr(job.output.format(0));
    if (o.resume && !exr) throw UsageError("--resume: only EXR files tell what they are of");
    const int any = std::max(job.frames.front(), 0);
    if (!o.explain && isSameFile(job.input.format(any), job.output.format(any)))
        throw UsageError("'" + o.output + "': the output is the input");
    return job;
}

void report(const DenoiseOptions& o, const ShotJob& job, const ShotSummary& summary, gpu::Device& device) {
    if (o.json) {
        const nlohmann::json object{{"output", o.output},
                                    {"denoiser", job.options.method->name},
                                    {"device", device.info().name},
                                    {"frames", summary.frames},
                                    {"seconds", summary.seconds},
                                    {"kept", summary.kept},
                                    {"skipped", summary.skipped},
                                    {"cuts", summary.cuts},
                                    {"last_frame_ms", summary.lastFrame}};
        fmt::print("{}\n", jsonText(object));
    } else {
        if (summary.kept > 0) log::info("{} frames were complete", summary.kept);
        if (!summary.cuts.empty()) log::info("cuts before frames {}", describeFrames(summary.cuts));
        log::info("{} frames by {}, on {}", summary.frames, job.options.method->name, device.info().name);
    }
}

/// Reads the cameras, if there are any, which stay in `cameras`.
void addCameras(const DenoiseOptions& o, std::optional<shot::CameraTrack>& cameras, ShotJob& job) {
    if (o.cameras.empty()) return;
    cameras = shot::CameraTrack::read(o.cameras, o.cameraTiming);
    job.options.cameras = &*cameras;
    job.settingsText += " " + hashText(cameras->hash());
    if (!job.input.numbered()) return;
    const std::vector<int> lacking = cameras->lacking(job.frames);
    if (!lacking.empty()) log::warn("{} has no camera for frames {}", o.cameras, describeFrames(lacking));
}

void denoiseFiles(const DenoiseOptions& o) {
    parseExposure(o.exposure);
    if (!o.explain && o.output.empty()) throw UsageError("--output is missing");
    if (!o.explain) checkPictureOutput(FramePattern(o.output).format(0), false);
    ShotJob job = jobOf(o);
    std::optional<shot::CameraTrack> cameras;
    addCameras(o, cameras, job);
    if (o.explain) return explainShot(job);
    const OpenDevice device = openDevice(o.device);
    job.options.networks = loadNetworks(*device, job.options.method, o.weights, job.options.settings);
    const ShotSummary summary = denoiseShot(job, *device);
    report(o, job, summary, *device);
    if (device->validationMessages() > 0)
        throw Error(fmt::format("the validation layer reported {} messages", device->validationMessages()));
}

void addFileOptions(CLI::App& command, DenoiseOptions& o) {
    command
        .add_option("IN", o.input,
                    "Input: frame.exr, or frame.%04d.exr for all existing frames; also .pfm, .hdr, .png")
        ->required();
    command.add_option("-o,--output", o.output,
                       "Output: EXR (everything that the input has, with a new beauty) or PNG");
    command.add_flag(
        "--explain", o.explain,
        "Print how each layer of the input is understood, what is missing and what that costs, and "
        "denoise nothing");
    command.add_option("--map", o.map,
                       "Say which layer something is: albedo=MyAlbedo.RGB, normal.space=camera; "
                       "docs/denoise-your-renders.md lists all (repeatable)");
    command.add_option(
        "--file", o.files,
        "A layer in a file of its own: albedo=albedo.%04d.pfm; EXR, PFM, HDR, PNG (repeatable)");
    command.add_option("--map-file", o.mapFile, "Read assignments of --map from a JSON file");
    command.add_option("--camera", o.cameras,
                       "Cameras of the frames: a JSON file (docs/denoise-your-renders.md), or a glTF file; "
                       "scene.glb#NAME chooses one of its cameras");
    command
        .add_option("--fps", o.cameraTiming.framesPerSecond,
                    "Frames per second of the animation in --camera scene.glb; default 24")
        ->check(CLI::Range(1e-3f, 1e6f));
    command.add_option(
        "--camera-start", o.cameraTiming.firstFrame,
        "Frame at time 0 of the animation in --camera scene.glb; default 0, as Blender exports");
    command.add_option("--frames", o.frames, "Only these frames of the input: 10-20");
    command.add_flag("--bidirectional", o.bidirectional,
                     "Denoise forwards and backwards and merge both, so that no frame lacks a history; takes "
                     "about twice as long");
    command
        .add_option("--strength", o.strength, "Share of the clean picture in the result: 0 to 1 (default)")
        ->check(CLI::Range(0.0f, 1.0f));
    command.add_option(
        "--shard", o.shard,
        "Only a part of the frames: 2/4 is the second of four; several processes can share a shot");
    command.add_flag(
        "--resume", o.resume,
        "Go on after the last complete output: EXR files say of which input and options they are");
    command.add_option("--cuts", o.cuts,
                       "Where the shot changes: auto (default), none, or the first frames after cuts: 12,40");
    command.add_option("--motion", o.motion,
                       "For sequences without a layer of motion: auto (default) searches it on albedo and "
                       "normals, none denoises each frame alone");
    command.add_option(
        "--on-error", o.onError,
        "What an unreadable frame does: stop (default), or skip, which also allows missing frames");
}

}  // namespace

void addDenoiseCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("denoise", "Denoise EXR frames of any renderer");
    auto o = std::make_shared<DenoiseOptions>();
    addFileOptions(*command, *o);
    command->add_option("--denoiser", o->denoiser,
                        "Denoiser: " + listOfDenoisers() + "; default svgf, or that of --preset");
    refuseMethodOption(*command);
    command->add_option("--preset", o->preset,
                        "Use a denoiser with the settings of a paper or course; 'limpid info' lists them; "
                        "other options override it");
    command->add_option("--set", o->assignments,
                        "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command->add_option("--weights", o->weights,
                        "Weights file for kpcn instead of the one that comes with Limpid");
    command->add_option("--exposure", o->exposure,
                        "Exposure of a PNG: stops (higher is brighter), or 'auto' (default): measured on "
                        "pixels that see a surface");
    command->add_option("--dump", o->dump, "Also write the images of this pass, beside the output");
    command->add_flag("--json", o->json, "Print one JSON object about the run on stdout");
    addDeviceOptions(*command, o->device);
    command->callback([o] { denoiseFiles(*o); });
}

}  // namespace limpid::cli
