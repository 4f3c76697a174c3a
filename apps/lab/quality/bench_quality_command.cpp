// `limpid bench quality`: compares denoised sequences with converged ones, in numbers and pictures.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>

#include "base/error.h"
#include "base/files/file.h"
#include "cli/cluster/session.h"
#include "cli/console/command_text.h"
#include "cli/options/former_options.h"
#include "cli/options/render_options.h"
#include "lab/bench.h"
#include "lab/quality/measure_sequence.h"
#include "lab/quality/measure_together.h"
#include "lab/quality/quality_options.h"
#include "lab/quality/quality_output.h"
#include "lab/quality/quality_sequences.h"
#include "renderer/method/network_file.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"
#include "scene/framing/camera_path.h"

namespace limpid::cli {
namespace {

std::vector<QualityMethod> methodsOf(const QualityOptions& o) {
    RenderSettings common;
    common.extent = {o.width, o.height};
    common.layers = true;  // the noisy frames are scored too
    for (const std::string& denoiser : o.methods.denoisers)
        common.pipeline.integrator =
            pipelineFor(o.preset, {.integrator = o.integrator, .denoiser = denoiser}, {}).integrator;
    applyPreset(common, o.preset);
    for (const std::string& text : o.assignments) assign(common, text);
    MethodChoice choice = o.methods;
    choice.samples = o.samples;
    if (!o.preset.empty()) choice.jitter = common.jitter;
    if (o.aliased) choice.jitter = Jitter::Off;  // like the references
    if (!o.jitter.empty()) choice.jitter = parseJitter(o.jitter);
    return methodsOf(choice, common);
}

/// Returns the sequences of --scene and --scenes-folder, then those of the lab.
std::vector<QualitySequence> chosenSequences(const QualityOptions& o) {
    const QualitySequence common{.cameraPath = o.cameraPath, .environment = o.environment};
    std::vector<QualitySequence> sequences;
    for (const std::string& scene : o.scenes) {
        sequences.push_back(common);
        sequences.back().name = sceneStem(scene);
        sequences.back().scene = scene;
    }
    if (!o.scenesFolder.empty()) {
        const std::vector<QualitySequence> found = sequencesInFolder(o.scenesFolder, o.pathsFolder, common);
        if (found.empty()) throw InputError(o.scenesFolder, "has no glTF files in its folders");
        sequences.insert(sequences.end(), found.begin(), found.end());
    }
    if (o.lab) sequences.insert(sequences.end(), labSequences().begin(), labSequences().end());
    return sequences;
}

std::vector<QualitySequence> sequencesOf(const QualityOptions& o) {
    std::vector<QualitySequence> sequences = chosenSequences(o);
    std::set<std::string> taken;  // file names of pictures and references derive from these
    for (QualitySequence& sequence : sequences) {
        const std::string name = sequence.name;
        for (int number = 2; !taken.insert(sequence.name).second; ++number)
            sequence.name = fmt::format("{}-{}", name, number);
        sequence.referenceSamples = o.referenceSamples.value_or(sequence.referenceSamples);
        QualityFrames& frames = sequence.frames;
        frames = {o.first.value_or(frames.first), o.frames.value_or(frames.count)};
        if (frames.first >= frames.count) {
            throw UsageError(
                fmt::format("{}: of {} frames none is compared, the first would be {}: see "
                            "--first and --frames",
                            sequence.name, frames.count, frames.first));
        }
    }
    return sequences;
}

/// Checks inputs that several sequences share, or that cannot be skipped, before the first sequence runs.
void checkInputs(const QualityOptions& o) {
    const auto mustExist = [](const std::string& file) {
        if (!std::filesystem::exists(file)) throw InputError(file, "does not exist");
    };
    if (!o.environment.empty()) mustExist(o.environment);
    for (const std::string& scene : o.scenes) {
        if (!scene.starts_with("builtin:")) mustExist(scene);
    }
    if (!o.pathsFolder.empty() && !std::filesystem::is_directory(o.pathsFolder))
        throw InputError(o.pathsFolder, "is no folder");
    if (o.cameraPath != "none" && !scene::isBuiltinCameraPath(o.cameraPath))
        scene::loadCameraPath(o.cameraPath);
}

/// Returns the methods with their networks loaded.
std::vector<QualityMethod> loadMethods(gpu::Device& device, const QualityOptions& o) {
    std::vector<QualityMethod> methods = methodsOf(o);
    for (QualityMethod& method : methods) {
        const denoise::Denoiser* const denoiser = method.settings.pipeline.denoiser;
        if (denoiser->network)
            method.settings.networks = loadNetworks(device, denoiser, o.weights, method.settings.denoisers);
    }
    return methods;
}

/// The sequences share what a report may take. Base64 makes four bytes of three.
uint64_t pictureBytesPerSequence(const QualityOptions& o, size_t sequences) {
    return uint64_t{o.reportMegabytes} * 1'000'000 * 3 / 4 / sequences;
}

void run(const QualityOptions& o, const std::string& command) {
    checkPictureSize({o.width, o.height});
    methodsOf(o);  // reports faults before the device is opened
    const std::vector<QualitySequence> sequences = sequencesOf(o);
    checkInputs(o);
    if (!o.report.empty() && isFirstProcess()) checkWritable(o.report);
    if (!o.folder.empty() && isFirstProcess()) makeFolder(o.folder);
    if (!o.referenceFolder.empty()) makeFolder(o.referenceFolder);
    const OpenDevice device = openDevice(o.device);
    checkPictureSize({o.width, o.height}, *device, true);  // references are means
    const std::vector<QualityMethod> methods = loadMethods(*device, o);
    const QualityRun head{.version = LIMPID_VERSION,
                          .command = command,
                          .device = device->info().name,
                          .driver = device->info().driver,
                          .tracer = std::string(scene::toString(chosenTracer(o.device, *device))),
                          .extent = {o.width, o.height},
                          .samples = o.samples};
    const auto measure = [&](size_t index) {
        return measureSequence(*device, o, methods, sequences.at(index),
                               pictureBytesPerSequence(o, sequences.size()));
    };
    const QualityDestinations destinations{.folder = o.folder, .report = o.report, .json = o.json};
    if (ranks()) return measureTogether(head, sequences, destinations, measure);
    QualityOutput output(head, sequences.size(), destinations);
    for (size_t index = 0; index < sequences.size(); ++index) output.add(index, measure(index));
    output.finish();
}

/// Otherwise an option would have no effect, without a word.
void checkGoTogether(const QualityOptions& o, const CLI::App& command) {
    if (!o.pathsFolder.empty() && o.scenesFolder.empty())
        throw UsageError("--paths-folder goes with --scenes-folder");
    if (!o.scenes.empty() || !o.scenesFolder.empty()) return;
    for (const char* option : {"--env", "--camera-path"})
        if (command.count(option) > 0)
            throw UsageError(fmt::format(
                "{} is for --scene and --scenes-folder; the sequences of --lab have their own", option));
}

/// Fills in defaults for options that were not given.
void complete(QualityOptions& o, const CLI::App& command) {
    const auto given = [&](const char* option) { return command.count(option) > 0; };
    if (o.quick) {
        if (!given("--width")) o.width = quick::width;
        if (!given("--height")) o.height = quick::height;
        o.first = o.first.value_or(quick::frames.first);
        o.frames = o.frames.value_or(quick::frames.count);
        o.referenceSamples = o.referenceSamples.value_or(quick::referenceSamples);
        if (o.scenes.empty() && o.scenesFolder.empty()) o.lab = true;
    }
    if (o.scenes.empty() && o.scenesFolder.empty() && !o.lab) o.scenes = {"builtin:cornell"};
    checkGoTogether(o, command);
    if (!o.methods.denoisers.empty()) return;
    for (const denoise::Denoiser& denoiser : denoise::denoisers()) {
        const Integrator integrator = o.integrator.empty() ? Integrator::Path : parseIntegrator(o.integrator);
        const bool fits = o.preset.empty() ? canBeDenoised(integrator, denoiser)
                                           : findPreset(o.preset).isForDenoiser(denoiser.name);
        if (fits && (!denoiser.network || o.samples >= minNetworkSamples))
            o.methods.denoisers.emplace_back(denoiser.name);
    }
    if (o.methods.denoisers.empty())
        throw UsageError("--preset " + o.preset + ": is for no denoiser that can be measured");
}

void addSequenceOptions(CLI::App& command, const std::shared_ptr<QualityOptions>& o) {
    command.add_option("--scene", o->scenes, "Scene to measure (repeatable; builtin:cornell)");
    command.add_flag("--lab", o->lab, "Measure the fixed set of built-in sequences");
    command.add_flag("--quick", o->quick,
                     "Small enough for a CPU: 160x90, frames 6 to 8, references of 256 samples, scenes under "
                     "1000 triangles; uses --lab unless scenes are named");
    command.add_option(
        "--scenes-folder", o->scenesFolder,
        "Measure all glTF scenes in the subfolders of this folder; scenes that cannot be loaded are skipped");
    command.add_option(
        "--paths-folder", o->pathsFolder,
        "Folder of camera paths NAME.json for these scenes; scenes without one use --camera-path");
    command.add_option("--env", o->environment, "Environment map for --scene and --scenes-folder");
    command.add_option(
        "--camera-path", o->cameraPath,
        "Camera path for --scene and --scenes-folder: orbit (default), dolly, shake, a file, or none");
    command.add_option("--frames", o->frames, "Number of frames (61; --lab has its own)")
        ->check(CLI::Range(1, 100000));
    command.add_option("--first", o->first, "First frame that is compared (16; --lab has its own)")
        ->check(CLI::Range(0, 100000));
    command.add_option("--spp", o->samples, "Samples per pixel and frame; more is less noisy (1)")
        ->check(CLI::Range(1, 65536));
    command
        .add_option(
            "--reference-spp", o->referenceSamples,
            "Samples per pixel of the references; more is more accurate and slower (4096; --lab has its own)")
        ->check(CLI::Range(2, 1 << 24));
    command.add_flag("--aliased", o->aliased,
                     "All rays go through pixel centres, those of references, too; default: references are "
                     "means over the pixels, which is what smooth edges are");
    command
        .add_option(
            "--jitter", o->jitter,
            "Ray position in the pixel, of the denoised frames: frame (one point per frame), off (centre) or "
            "pixel (random); default: as 'limpid render' has it with the denoiser or the preset")
        ->check(CLI::IsMember({"frame", "off", "pixel"}));
    command.add_option("--reference-folder", o->referenceFolder,
                       "Folder that keeps references; existing ones are read instead of rendered");
    command.add_option("--width", o->width, "Picture width, pixels (640)")->check(CLI::Range(1, 65535));
    command.add_option("--height", o->height, "Picture height, pixels (360)")->check(CLI::Range(1, 65535));
}

}  // namespace

void addQualityBench(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand(
        "quality", "Compare denoised sequences with converged ones: PSNR, SSIM, FLIP, flicker");
    auto o = std::make_shared<QualityOptions>();
    addSequenceOptions(*command, o);
    command->add_option("--integrator", o->integrator,
                        "Integrator whose output is denoised: path (default), direct or ao");
    command->add_option("--denoiser", o->methods.denoisers,
                        "Denoiser to measure (repeatable; default: all, kpcn only from --spp 8 on)");
    refusePipelineOption(*command);
    command->add_option("--weights", o->weights,
                        "Weights file for kpcn instead of the one that comes with Limpid");
    command->add_option("--preset", o->preset,
                        "Preset of a denoiser from a paper or course; 'limpid info' lists them");
    command->add_option("--set", o->assignments,
                        "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command->add_option("--variant", o->methods.variants,
                        "Measure a denoiser again with other parameters, comma-separated, or preset=NAME; "
                        "parameters of no denoiser apply to the last one (repeatable)");
    command->add_flag(
        "--steps", o->methods.steps,
        "Measure SVGF's presets, and SVGF without each of its extensions and with former defaults");
    command->add_option("--out", o->folder, "Folder for a side-by-side picture of each scene");
    command->add_option("--report", o->report,
                        "HTML report with all results and the pictures of every compared frame");
    command
        ->add_option("--report-size", o->reportMegabytes,
                     "Megabytes that the pictures of a report may take (64); if the frames take more, "
                     "only every second, third, ... is kept; the last always is")
        ->check(CLI::Range(1, 400));
    command->add_flag("--json", o->json, "Print one JSON object on stdout");
    addDeviceOptions(*command, o->device);
    command->callback([o, command] {
        complete(*o, *command);
        run(*o, "limpid bench " + commandText(*command));
    });
}

}  // namespace limpid::cli
