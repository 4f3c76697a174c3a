#include "cli/options/render_options.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "base/error.h"
#include "base/files/file.h"
#include "base/files/frame_pattern.h"
#include "base/log.h"
#include "cli/console/help_text.h"
#include "cli/render/clip_output.h"
#include "cli/render/picture_output.h"
#include "image/tone_curve.h"
#include "renderer/layers/layers.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"
#include "scene/framing/camera_path.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;

void checkClip(const RenderOptions& o) {
    if (FramePattern(o.output).numbered())
        throw UsageError("'" + o.output + "': a clip is one file, whose name holds no frame number");
    if (isLongRender(o.longRender))
        throw UsageError(
            "--checkpoint, --resume, --shard and --time-limit are not for clips: render frame.%04d.png");
    if (!o.layers.empty()) throw UsageError("--aov needs an .exr output");
    if (o.floatExr) throw UsageError("--float needs an .exr output");
    if (!o.dump.empty()) throw UsageError("--dump is not for clips: render frame.%04d.exr");
    checkClipOutput(FramePattern(o.output).format(0));
}

/// A checkpoint keeps how pictures look, for those that 'limpid merge' makes of it, .exr or .png.
bool hasCheckpoint(const RenderOptions& o) {
    return !o.longRender.checkpoint.empty();
}

/// Not refused: the window's command lines have the tone curve that it shows.
void warnOfUnusedLook(const RenderOptions& o, const fs::path& path) {
    const bool exposure = o.exposure != "auto", curve = o.toneCurve != "standard";
    if ((!exposure && !curve) || hasCheckpoint(o)) return;
    const char* const have = exposure && curve ? "--exposure and --tone-curve have"
                             : exposure        ? "--exposure has"
                                               : "--tone-curve has";
    const Pipeline pipeline = pipelineOf(o);
    if (!pipeline.needsExposure())
        log::warn("{} no effect: the values of --integrator {} are shown as they are", have,
                  nameOf(pipeline.integrator));
    else if (isExr(path) && !o.preview)
        log::warn("{} no effect: an .exr is linear, unlike .png and videos", have);
}

void checkOutput(const RenderOptions& o) {
    const fs::path path = FramePattern(o.output).format(0);
    warnOfUnusedLook(o, path);
    if (isClip(path)) return checkClip(o);
    const bool sums = path.extension() == ".sums";
    if (sums != writesSums(o)) {
        throw UsageError(
            "'" + o.output +
            (sums ? "': only a shard of a still is written to a .sums file"
                  : "': the name of a still's shard ends in .sums; 'limpid merge' makes the picture"));
    }
    if (sums) return checkWritable(path);
    checkPictureOutput(path, !o.layers.empty());
    if (o.floatExr && !isExr(path) && !hasCheckpoint(o)) throw UsageError("--float needs an .exr output");
    if (o.preview) checkWritable(previewFile(path));
}

/// None if the folder cannot be listed: frames can be written there all the same.
std::vector<int> existingFrames(const FramePattern& output) {
    try {
        return output.existingFrames();
    } catch (const InputError&) {
        return {};
    }
}

/// Returns the frames of the output whose file may be one of these.
std::vector<int> framesThatMayBe(const FramePattern& output, const std::vector<fs::path>& files) {
    if (!output.numbered()) return {0};
    std::vector<int> frames = existingFrames(output);  // one may be a symbolic link
    for (const fs::path& file : files) {
        for (const fs::path& name : {file, linkTarget(file)}) {
            if (const std::optional<int> frame = output.frameOf(name.filename().string()))
                frames.push_back(*frame);
        }
    }
    return frames;
}

/// With links followed; empty if that is not possible.
fs::path canonicalPath(const fs::path& file) {
    std::error_code fault;
    return fs::weakly_canonical(file, fault);
}

/// Otherwise the checkpoint and the output would overwrite each other.
void checkCheckpointIsNoOutput(const RenderOptions& o) {
    if (o.longRender.checkpoint.empty()) return;
    const FramePattern output(o.output);
    for (const int frame : framesThatMayBe(output, {o.longRender.checkpoint})) {
        const fs::path file = output.format(frame);
        if (isSameFile(file, o.longRender.checkpoint))
            throw UsageError("--checkpoint: '" + o.longRender.checkpoint + "' is the output '" +
                             file.string() + "'; they must be two files");
    }
}

/// The environment map would be gone.
void checkEnvironmentIsNoOutput(const RenderOptions& o) {
    const std::string& environment = o.scene.source.environment;
    if (environment.empty()) return;
    const FramePattern output(o.output);
    for (const int frame : framesThatMayBe(output, {environment})) {
        if (isSameFile(output.format(frame), environment))
            throw UsageError("--env: '" + environment + "' is the output, which would replace it");
    }
}

/// Otherwise one of two options would have no effect, without a word.
void checkScene(const RenderOptions& o) {
    const SceneChoice& c = o.scene;
    if (!c.source.environment.empty() && !c.source.background.empty())
        throw UsageError("--env and --background are two environments: give one of them");
    const std::string& path = o.sequence.cameraPath;
    const bool cameraGiven =
        !c.camera.empty() || !c.eye.empty() || !c.target.empty() || !c.up.empty() || c.fov > 0.0f;
    if (cameraGiven && !path.empty() && !scene::isBuiltinCameraPath(path))
        throw UsageError(
            "--camera-path '" + path +
            "' has its own cameras: --camera, --eye, --target, --up and --fov do not go with it");
    if (c.fov > 0.0f && o.lens.focalLength > 0.0f)
        throw UsageError("--fov and --focal-length say the same: give one of them");
}

void checkShutter(const RenderOptions& o) {
    const Shutter& shutter = o.sequence.timing.shutter;
    if (!shutter.isOpen() && shutter != Shutter{}) throw UsageError("--shutter-position goes with --shutter");
    if (shutter.isOpen() && (!hasIndependentFrames(pipelineOf(o)) || isProgressive(o)))
        throw UsageError(
            "--shutter is for --integrator path or direct, --denoiser none and no --progressive: denoisers "
            "follow sharp surfaces from frame to frame");
}

bool setsMaxDepth(const std::string& text) {
    const Assignment assignment = parseAssignment(text);
    return assignment.group == "pathtrace" && assignment.name == "max_depth";
}

/// Otherwise it would have no effect, or not the one that was asked for.
void checkMaxDepth(const RenderOptions& o, const Pipeline& pipeline) {
    const bool isSet = std::ranges::any_of(o.assignments, setsMaxDepth);
    if (o.maxDepth < 0 && !isSet) return;
    const std::string option = isSet ? "--set pathtrace.max_depth" : "--max-depth";
    if (pipeline.takesOneSampleALaunch())
        throw UsageError(option + " is for --integrator path and direct: " + pipeline.options() +
                         " follows no paths");
    if (pipeline.integrator == Integrator::Direct && settingsOf(o).pathtrace.maxDepth > 1)
        throw UsageError(option + ": --integrator direct has one bounce at most");
}

void addOutputOptions(CLI::App& command, RenderOptions& o) {
    const OptionGroup group(command, "Output");
    command
        .add_option("-o,--output", o.output,
                    "Output: .exr (linear, layers) or .png (tone-mapped), frame.%04d.exr for several frames, "
                    "or a video by ffmpeg: .mp4, .webm, .webp or .gif")
        ->required();
    command.add_option("--width", o.width, "Picture width, pixels (1280)")->check(CLI::Range(1, 65535));
    command.add_option("--height", o.height, "Picture height, pixels (720)")->check(CLI::Range(1, 65535));
    command.add_option(
        "--exposure", o.exposure,
        "Exposure of a PNG or video: stops (higher is brighter), or 'auto' (default): measured on "
        "pixels that see a surface");
    command
        .add_option(
            "--tone-curve", o.toneCurve,
            "Tone curve of a PNG or video: standard (filmic, default), agx (bright colours turn white), none "
            "(clipped) or false-color (a colour for each stop of luminance)")
        ->check(CLI::IsMember(image::toneCurveNames()));
    std::string layers;
    for (const std::string& layer : layerNames()) layers += " " + layer;
    command.add_option("--aov", o.layers, "EXR layers besides beauty, comma-separated, or 'all':" + layers);
    command.add_option("--dump", o.dump, "Also write the images of this pass, beside the output");
    command.add_flag("--float", o.floatExr, "Store colours in the EXR in 32 bits instead of 16");
    command.add_flag("--json", o.json, "Print one JSON object about the run on stdout");
    command.add_flag(
        "--preview", o.preview,
        "Of a still: write the picture so far every few seconds, to OUTPUT if it is a .png, else to a "
        "name.preview.png beside it");
}

void addSamplingOptions(CLI::App& command, RenderOptions& o) {
    const OptionGroup group(command, "Sampling");
    command
        .add_option(
            "--spp", o.samples,
            "Samples per pixel (64), with a denoiser per pixel and frame (1; film 16, kpcn 32); more is "
            "less noisy and slower")
        ->check(CLI::Range(1, 1 << 24));
    command
        .add_option("--samples-per-launch", o.samplesPerLaunch,
                    "Samples per pixel in one launch (1); more is a little faster; at most 4 on a CPU, "
                    "16 with Sobol' points")
        ->check(CLI::Range(1, 4096));
    command
        .add_option("--max-depth", o.maxDepth,
                    "Maximum number of bounces (8, with --integrator direct 1); the same as --set "
                    "pathtrace.max_depth")
        ->check(CLI::Range(0, 1024));
    command.add_option("--seed", o.seed, "Random seed; another seed gives other noise (0)");
    command
        .add_option("--sampler", o.sampler,
                    "Random numbers: pcg (independent), sobol (default, spread evenly over samples and "
                    "neighbouring pixels: less noise) or tea (a poor generator)")
        ->check(CLI::IsMember({"pcg", "sobol", "tea"}));
    command
        .add_option("--jitter", o.jitter,
                    "Ray position in the pixel: pixel (random), frame (one point per frame) or off (centre); "
                    "default: frame with denoisers that keep a history, off with bilateral, else pixel")
        ->check(CLI::IsMember({"pixel", "frame", "off"}));
}

void addMethodOptions(CLI::App& command, RenderOptions& o) {
    const OptionGroup group(command, "Method");
    addPipelineOptions(command, o.pipeline, "path, or the preset's", "none, or the preset's");
    command.add_option("--preset", o.preset,
                       "Use all settings of a paper, course or tutorial, as in svgf-paper; 'limpid info' "
                       "lists them; other options override it");
    command.add_option("--set", o.assignments,
                       "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command.add_option("--weights", o.weights,
                       "Weights file for kpcn instead of the one that comes with Limpid");
    command.add_flag("--progressive", o.progressive,
                     "Accumulate in single precision, launch after launch, as the window does; only without "
                     "a denoiser, --resume, --shard and --time-limit");
}

}  // namespace

Jitter parseJitter(const std::string& name) {
    return name == "pixel" ? Jitter::Pixel : name == "frame" ? Jitter::Frame : Jitter::Off;
}

void addRenderOptions(CLI::App& command, RenderOptions& o) {
    addSceneOptions(command, o.scene);
    addLensOptions(command, o.lens);
    addOutputOptions(command, o);
    addSamplingOptions(command, o);
    addMethodOptions(command, o);
    addSequenceOptions(command, o.sequence);
    addLongRenderOptions(command, o.longRender);
    addDeviceOptions(command, o.device);
}

Pipeline pipelineOf(const RenderOptions& o) {
    return pipelineFor(o.preset, o.pipeline, {});
}

bool hasIndependentFrames(const Pipeline& pipeline) {
    return !pipeline.denoiser && !pipeline.takesOneSampleALaunch();
}

bool isProgressive(const RenderOptions& o) {
    const bool byPreset = !o.preset.empty() && findPreset(o.preset).progressive;
    return o.progressive || (byPreset && !isLongRender(o.longRender));
}

RenderSettings settingsOf(const RenderOptions& o) {
    RenderSettings settings;
    settings.extent = {o.width, o.height};
    settings.seed = o.seed;
    settings.samplesPerLaunch = o.samplesPerLaunch;
    settings.pipeline = pipelineOf(o);
    settings.jitter = defaultJitter(settings.pipeline, samplesOf(o));
    settings.layers = !o.layers.empty();
    applyPreset(settings, o.preset);
    if (!o.jitter.empty()) settings.jitter = parseJitter(o.jitter);
    if (!o.sampler.empty()) {
        settings.pathtrace.samplerTea = o.sampler == "tea";
        settings.pathtrace.samplerSobol = o.sampler == "sobol";
    }
    if (o.maxDepth >= 0) settings.pathtrace.maxDepth = o.maxDepth;
    for (const std::string& text : o.assignments) assign(settings, text);
    return settings;
}

uint64_t samplesOf(const RenderOptions& o) {
    if (o.samples > 0) return o.samples;
    const Pipeline pipeline = pipelineOf(o);
    if (pipeline.accumulates()) return 64;
    return pipeline.denoiser->samples;
}

bool writesSums(const RenderOptions& o) {
    return !FramePattern(o.output).numbered() && chosenShard(o.longRender.shard).count > 1;
}

std::vector<std::string> chosenLayers(const RenderOptions& o) {
    const Pipeline pipeline = pipelineOf(o);
    const std::vector<std::string> possible = pipeline.layers();
    if (o.layers == "all") return possible;
    const std::vector<std::string> chosen = parseLayers(o.layers);
    for (const std::string& name : chosen) {
        if (std::ranges::find(possible, name) == possible.end())
            throw UsageError("--aov: " + pipeline.options() + " has no layer '" + name + "'");
    }
    std::vector<std::string> layers;
    std::ranges::copy_if(possible, std::back_inserter(layers), [&](const std::string& name) {
        return std::ranges::find(chosen, name) != chosen.end();
    });
    return layers;
}

void checkSceneIsNoOutput(const RenderOptions& o, const scene::Scene& scene, int frames) {
    if (scene.files.empty()) return;
    std::set<fs::path> files;
    for (const fs::path& file : scene.files) files.insert(canonicalPath(file));
    files.erase(fs::path());
    const FramePattern output(o.output);
    std::vector<fs::path> outputs;
    for (const int frame : framesThatMayBe(output, scene.files))
        if (frame < frames) outputs.push_back(output.format(frame));
    if (o.preview) outputs.push_back(previewFile(output.format(0)));
    for (const fs::path& file : outputs)
        if (files.contains(canonicalPath(file)))
            throw UsageError("'" + file.string() +
                             "' is a file of the scene, which the output would replace");
}

void checkRenderOptions(const RenderOptions& o) {
    const Pipeline pipeline = pipelineOf(o);
    checkPictureSize({o.width, o.height});
    if (o.progressive && isLongRender(o.longRender))
        throw UsageError("--progressive: not with --checkpoint, --resume, --shard and --time-limit");
    if (!hasIndependentFrames(pipeline) && isLongRender(o.longRender)) {
        throw UsageError(
            "--checkpoint, --resume, --shard and --time-limit are for --integrator path or direct and "
            "--denoiser none: the frames of " +
            pipeline.options() + " build on each other");
    }
    if (!pipeline.accumulates() && samplesOf(o) > 65536)
        throw UsageError("--spp: a frame that is denoised takes 65536 samples at most");
    if (o.preview && (!hasIndependentFrames(pipeline) || o.progressive || FramePattern(o.output).numbered() ||
                      isClip(FramePattern(o.output).format(0)) || writesSums(o)))
        throw UsageError("--preview is for stills by --integrator path or direct and --denoiser none");
    checkLens(o.lens, pipeline);
    checkShutter(o);
    checkMaxDepth(o, pipeline);
    checkScene(o);
    checkLongRender(o.longRender);
    checkOutput(o);
    checkCheckpointIsNoOutput(o);
    checkEnvironmentIsNoOutput(o);
    parseExposure(o.exposure);
    chosenLayers(o);
    settingsOf(o);
    for (const std::string& text : o.assignments)
        checkTakesPart(groupsOf(pipeline), text, pipeline.options());
}

}  // namespace limpid::cli
