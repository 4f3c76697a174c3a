// `limpid denoise`: denoises frames of any renderer.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "cli/cluster/session.h"
#include "cli/commands.h"
#include "cli/console/help_text.h"
#include "cli/console/interrupt.h"
#include "cli/console/json_text.h"
#include "cli/console/pass_times.h"
#include "cli/console/progress.h"
#include "cli/denoise_windows.h"
#include "cli/options/device_options.h"
#include "cli/options/former_options.h"
#include "cli/options/pipeline_options.h"
#include "cli/render/render_job.h"
#include "renderer/frame/frame_download.h"
#include "renderer/method/network_file.h"
#include "shot/run/denoise_shot.h"
#include "shot/run/explain_shot.h"
#include "shot/run/shot_request.h"

namespace limpid::cli {
namespace {

struct DenoiseOptions {
    shot::ShotRequest request;
    std::string dump;
    DeviceChoice device;
    size_t window = 0;  ///< frames; 0: automatic
    bool json = false, explain = false;
};

/// Milliseconds by pass.
using Times = std::map<std::string, double>;

void report(const DenoiseOptions& o, const shot::ShotJob& job, const shot::ShotSummary& summary,
            const std::vector<uint64_t>& madeByProcess, const Times& lastFrame, uint64_t deviceBytes,
            gpu::Device& device) {
    const std::string_view denoiser = job.options.method->name;
    if (o.json) {
        nlohmann::json object{{"output", o.request.output},   {"denoiser", denoiser},
                              {"device", device.info().name}, {"frames", summary.frames},
                              {"seconds", summary.seconds},   {"kept", summary.kept},
                              {"skipped", summary.skipped},   {"cuts", summary.cuts},
                              {"last_frame_ms", lastFrame},   {"device_bytes", deviceBytes}};
        if (!madeByProcess.empty()) object["pieces_by_process"] = madeByProcess;
        fmt::print("{}\n", jsonText(object));
    } else {
        if (!madeByProcess.empty()) log::info("{}", describePieces(madeByProcess, "windows"));
        if (summary.kept > 0) log::info("{} frames were complete", summary.kept);
        if (!summary.skipped.empty())
            log::info("skipped frames that could not be read: {}", describeFrames(summary.skipped));
        if (!summary.cuts.empty()) log::info("cuts before frames {}", describeFrames(summary.cuts));
        log::info("wrote {}: {} frames by {}, in {}, on {}", o.request.output, summary.frames, denoiser,
                  durationText(summary.seconds), device.info().name);
    }
}

void denoiseFiles(DenoiseOptions& o) {
    if (o.explain)
        o.request.output.clear();
    else if (o.request.output.empty())
        throw UsageError("--output is missing");
    refuseInCluster(!o.request.shard.empty(),
                    "--shard: the processes of a cluster share out the work by themselves");
    shot::ShotJob job = shot::jobOf(o.request);
    if (o.explain) {
        if (isFirstProcess()) fmt::print("{}", shot::explainShot(job));
        return;
    }
    const InterruptGuard guard;
    const OpenDevice device = openDevice(o.device);
    job.options.networks = loadNetworks(*device, job.options.method, job.weights, job.options.settings);
    job.messages = log::write;
    Times lastFrame;
    uint64_t deviceBytes = 0;
    job.afterFrame = [&](int frame, gpu::FrameGraph& graph) {
        deviceBytes = std::max(deviceBytes, device->allocatedBytes());
        lastFrame = sumByName(graph.passTimes(*device));
        if (!o.dump.empty()) writeDump(outputOf(job, frame), imagesOfPass(graph, *device, o.dump));
    };
    std::vector<uint64_t> madeByProcess;
    const shot::ShotSummary summary = denoiseInWindows(job, o.window, *device, madeByProcess);
    if (isFirstProcess()) report(o, job, summary, madeByProcess, lastFrame, deviceBytes, *device);
    if (device->validationMessages() > 0)
        throw Error(fmt::format("the validation layer reported {} messages", device->validationMessages()));
    endIfInterrupted();
}

void addFileOptions(CLI::App& command, shot::ShotRequest& o) {
    command
        .add_option("IN", o.input,
                    "Input: frame.exr, or frame.%04d.exr for all existing frames; also .pfm, .hdr, .png")
        ->required();
    command.add_option("-o,--output", o.output,
                       "Output: EXR (everything that the input has, with a new beauty) or PNG");
}

void addLayerOptions(CLI::App& command, shot::ShotRequest& o) {
    const OptionGroup group(command, "Layers and cameras");
    command.add_option("--map", o.map,
                       "Say which layer something is: albedo=MyAlbedo.RGB, normal.space=camera; "
                       "docs/denoise-your-renders.md lists all (repeatable)");
    command.add_option(
        "--file", o.files,
        "A layer in a file of its own: albedo=albedo.%04d.pfm; EXR, PFM, HDR; PNG for colours (repeatable)");
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
}

void addFilmOptions(CLI::App& command, shot::ShotRequest& o, size_t& window) {
    const OptionGroup group(command, "Films");
    command.add_option("--frames", o.frames,
                       "Write only these frames of the input: 10-20; those around them make histories");
    command.add_flag("--bidirectional", o.bidirectional,
                     "Denoise forwards and backwards and merge both, so that no frame lacks a history; takes "
                     "about twice as long");
    command
        .add_option("--strength", o.strength, "Share of the clean picture in the result: 0 to 1 (default)")
        ->check(CLI::Range(0.0f, 1.0f));
    command
        .add_option(
            "--preserve", o.preserve,
            "Share of what was filtered away, in the mean over 5x5 pixels, that is given back: 0 (default) "
            "to 1; more detail and more noise")
        ->check(CLI::Range(0.0f, 1.0f));
    command.add_option("--recover", o.recover,
                       "Give back what the filter took away besides noise, by what the noise of neighbours "
                       "and frames tells: "
                       "auto (default: svgf, nano and film, files of Cycles and pbrt-v4), on, off");
    command.add_option(
        "--shard", o.shard,
        "Only a part of the frames: 2/4 is the second of four; several processes can share a shot");
    command
        .add_option(
            "--window", window,
            "Denoise the shot in parts of this many frames, each after a run-up of 16, with the results of "
            "mpirun; default: all frames in one, or 32 with mpirun")
        ->check(CLI::Range(1, 1000000));
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
    addFileOptions(*command, o->request);
    addLayerOptions(*command, o->request);
    addFilmOptions(*command, o->request, o->window);
    command->add_flag(
        "--explain", o->explain,
        "Print how each layer of the input is understood, what is missing and what that costs, and "
        "denoise nothing");
    command->add_option("--denoiser", o->request.denoiser,
                        "Denoiser: " + listOfDenoisers() + "; default svgf, or that of --preset");
    refuseMethodOption(*command);
    command->add_option("--preset", o->request.preset,
                        "Use a denoiser with the settings of a paper or course; 'limpid info' lists them; "
                        "other options override it");
    command->add_option("--set", o->request.settings,
                        "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command->add_option("--weights", o->request.weights,
                        "Weights file for kpcn instead of the one that comes with Limpid");
    command->add_option("--exposure", o->request.exposure,
                        "Exposure of a PNG: stops (higher is brighter), or 'auto' (default): measured on "
                        "pixels that see a surface");
    command->add_option("--dump", o->dump, "Also write the images of this pass, beside the output");
    command->add_flag("--json", o->json, "Print one JSON object about the run on stdout");
    addDeviceOptions(*command, o->device);
    command->callback([o] { denoiseFiles(*o); });
}

}  // namespace limpid::cli
