// `limpid render`: renders a scene to image files or a clip.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/clock.h"
#include "base/error.h"
#include "base/files/file.h"
#include "base/log.h"
#include "cli/cluster/session.h"
#include "cli/commands.h"
#include "cli/console/interrupt.h"
#include "cli/render/render_job.h"
#include "image/io/exr/exr.h"
#include "renderer/long/block_renderer.h"
#include "renderer/long/render_identity.h"
#include "renderer/method/network_file.h"

namespace limpid::cli {

namespace fs = std::filesystem;

void writeDump(const fs::path& output, const std::vector<std::pair<std::string, image::Image>>& images) {
    for (const auto& [name, picture] : images) {
        std::string flat = name;
        std::ranges::replace(flat, '/', '.');
        if (const size_t mark = flat.find(" (previous)"); mark != std::string::npos)
            flat.replace(mark, std::string::npos, ".previous");
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

void writeFrame(const RenderJob& job, uint64_t frame, const PictureFormat& format,
                const RenderedLayers& layers, const std::map<std::string, std::string>& metadata) {
    if (job.clip) return job.clip->add(beautyOf(layers), surfaceShare(layers));
    writePicture(FramePattern(job.options.output).format(static_cast<int>(frame)), format, layers, metadata);
}

namespace {

/// A few sharp pictures over each other are no blur.
void warnAboutShutter(const RenderJob& job) {
    constexpr uint64_t enough = 16;
    if (!job.options.sequence.timing.shutter.isOpen()) return;
    if (!job.sequence.isBlurred()) return log::warn("--shutter: nothing moves, there is nothing to blur");
    const BlockPlan plan = planBlocks(job.device, job.settings, samplesOf(job.options));
    if (plan.launches() < std::min(plan.samples, enough))
        log::warn(
            "--shutter: each launch sees one instant, and there are {} launches; lower --samples-per-launch",
            plan.launches());
}

void renderFrames(const RenderJob& job, RenderSummary& summary) {
    warnAboutShutter(job);
    if (hasIndependentFrames(job.settings.pipeline) && !isProgressive(job.options)) {
        renderIndependentFrames(job, summary);
    } else {
        renderSuccessiveFrames(job, summary);
    }
}

/// Throws UsageError if there are several processes, which cannot do this.
void checkCluster(const RenderOptions& o) {
    const Pipeline pipeline = pipelineOf(o);
    refuseInCluster(
        !hasIndependentFrames(pipeline) || isProgressive(o),
        "several processes share out frames that are independent: the frames of " + pipeline.options() +
            " build on each other. Render noisy frames with --integrator path --denoiser none --aov all, "
            "then run 'limpid denoise'; or use one process");
    refuseInCluster(isClip(FramePattern(o.output).format(0)),
                    "'" + o.output + "': a clip is written by one process: render frame.%04d.png");
    refuseInCluster(!o.longRender.shard.empty(),
                    "--shard: the processes of a cluster share out the work by themselves");
    refuseInCluster(o.preview, "--preview is for one process");
}

void renderClip(RenderJob job, RenderSummary& summary) {
    const RenderOptions& o = job.options;
    const fs::path file = FramePattern(o.output).format(0);
    // Left behind by a process that was killed while writing.
    removeStaleTemporaries(file);
    writeAtomicallyIf(file, [&](const fs::path& temporary) {
        ClipWriter clip(temporary, {.width = job.settings.extent.width,
                                    .height = job.settings.extent.height,
                                    .framesPerSecond = o.sequence.timing.framesPerSecond,
                                    .toneCurve = image::parseToneCurve(o.toneCurve),
                                    .stops = parseExposure(o.exposure),
                                    .shownAsIs = !job.settings.pipeline.needsExposure()});
        job.clip = &clip;
        renderFrames(job, summary);
        // Interrupted before its first frame: an older clip stays, and the report says so.
        if (clip.isEmpty()) return false;
        clip.finish();
        return true;
    });
}

void render(const RenderOptions& o) {
    checkRenderOptions(o);
    checkCluster(o);
    const InterruptGuard guard;
    RenderSettings settings = settingsOf(o);
    const FramePattern output(o.output);
    RenderSummary summary;
    const Clock::time_point started = Clock::now();
    // Before the scene, which may take minutes: the device knows whether the picture is too large.
    const OpenDevice device = openDevice(o.device);
    checkPictureSize(settings.extent, *device, settings.pipeline.accumulates());
    summary.timings.uploadSeconds = secondsSince(started);

    const Clock::time_point loadStart = Clock::now();
    scene::Scene scene = scene::openScene(o.scene.source);
    chooseAnimation(o.sequence, output, scene);
    const scene::Camera camera = chosenCamera(scene, o.scene);
    const std::optional<scene::CameraPath> path = chosenPath(o.sequence, scene, camera);
    summary.frames = frameCount(o.sequence, output, scene, path);
    checkSceneIsNoOutput(o, scene, summary.frames);
    checkLensOf(scene::withLens(path ? path->widest() : camera, o.lens), o.lens, settings.pipeline);
    if (summary.frames == 1 && output.numbered() && chosenShard(o.longRender.shard).count > 1)
        throw UsageError("--shard: the sequence has one frame only, which is a still: name a .sums file");
    summary.timings.loadSeconds = secondsSince(loadStart);

    const Clock::time_point uploadStart = Clock::now();
    if (settings.pipeline.usesNetwork() && samplesOf(o) < minNetworkSamples)
        log::warn("{} learnt from frames of 32 samples; {} tell it little", settings.pipeline.denoiser->name,
                  samplesOf(o));
    settings.networks = loadNetworks(*device, settings.pipeline.denoiser, o.weights, settings.denoisers);
    scene::SceneData data = scene::buildSceneData(scene);
    scene::GpuScene gpuScene(*device, data, {chosenTracer(o.device, *device), {}});
    const Sequence sequence(scene, data, camera, path, o.sequence.timing, o.lens);
    const uint64_t content = sceneHash(scene, data);
    data = {};  // now on the device, like the textures
    scene.textures.clear();
    summary.timings.uploadSeconds += secondsSince(uploadStart);

    const RenderJob job{o, settings, *device, gpuScene, sequence, content, summary.frames, started};
    if (isClip(output.format(0))) {
        renderClip(job, summary);
    } else {
        renderFrames(job, summary);
    }
    if (isFirstProcess()) reportRender(o, *device, summary, scene, gpuScene);
    // A script that goes on with --resume would begin with the same work again and again.
    if (summary.lostState && !summary.complete)
        throw Error("the last checkpoint could not be written: the work since the one before is lost");
    if (device->validationMessages() > 0) {
        throw Error(fmt::format("the validation layer reported {} messages", device->validationMessages()));
    }
    endIfInterrupted();
}

}  // namespace

void addRenderCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Render a scene to EXR or PNG files");
    auto options = std::make_shared<RenderOptions>();
    addRenderOptions(*command, *options);
    command->callback([options] { render(*options); });
}

}  // namespace limpid::cli
