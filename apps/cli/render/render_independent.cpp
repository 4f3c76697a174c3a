// `limpid render` with the path tracer and no denoiser: stills, and sequences whose frames are independent.
#include <algorithm>

#include "base/files/file.h"
#include "base/log.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/render/picture_output.h"
#include "cli/render/render_job.h"
#include "renderer/frame/camera_text.h"
#include "renderer/long/long_render.h"
#include "renderer/long/render_identity.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds previewEvery{3};

/// Where --preview writes.
fs::path previewFile(fs::path output) {
    return isExr(output) ? output.replace_extension(".preview.png") : output;
}

/// Returns the header that describes this render in files of sums and pictures.
AccumulationHeader headerOf(const RenderJob& job) {
    const RenderOptions& o = job.options;
    const RenderSettings& settings = job.settings;
    const auto frames = static_cast<uint64_t>(job.frames);
    AccumulationHeader header;
    const RenderIdentity identity{.version = LIMPID_VERSION,
                                  .sceneName = fs::path(o.scene.source.scene).filename().string(),
                                  .scene = job.sceneContent,
                                  .cameras = cameraHash(job.sequence, frames, settings.extent),
                                  .camera = cameraText(job.sequence.camera(0, settings.extent))};
    header.identity = identityOf(identity, settings, o.sequence.timing);
    header.extent = settings.extent;
    header.plan = planBlocks(job.device, settings, samplesOf(o));
    header.layers = chosenLayers(o);
    header.frames = frames;
    header.shard = chosenShard(o.longRender.shard);
    header.frame = frames > 1 ? header.shard.at(0) : 0;
    header.device = validUtf8(job.device.info().name);
    header.driver = validUtf8(job.device.info().driver);
    header.tracer = scene::toString(job.scene.tracer());
    header.floatColors = o.floatExr;
    header.exposure = o.exposure;
    header.toneCurve = o.toneCurve;
    return header;
}

/// A few sharp pictures over each other are no blur.
void warnOfFewInstants(const Sequence& sequence, const BlockPlan& plan) {
    constexpr uint64_t enough = 16;
    if (!sequence.isBlurred() || plan.launches() >= std::min(plan.samples, enough)) return;
    log::warn(
        "--shutter: each launch sees one instant, and there are {} launches; lower --samples-per-launch",
        plan.launches());
}

}  // namespace

void renderIndependentFrames(const RenderJob& job, RenderSummary& summary) {
    const RenderOptions& o = job.options;
    const AccumulationHeader header = headerOf(job);
    const FramePattern output(o.output);
    FrameRenderer frames(job.device, job.scene, job.settings, header.plan.samples);
    BlockRenderer renderer(frames, header.plan);
    LongRender render(renderer, job.sequence, header);
    warnOfFewInstants(job.sequence, header.plan);
    if (o.longRender.timeLimit > 0.0) {
        const std::chrono::duration<double> limit(o.longRender.timeLimit);
        render.setDeadline(job.started + std::chrono::duration_cast<LongRender::Clock::duration>(limit));
    }
    render.setStop(interrupted);
    if (o.preview) render.setPreview(previewEvery);
    if (!o.longRender.checkpoint.empty())
        render.setCheckpoint(Checkpoint(o.longRender.checkpoint), o.longRender.resume);
    Progress progress("samples", render.samplesToDo());
    const auto file = [&](uint64_t frame) { return output.format(static_cast<int>(frame)); };
    const auto finish = [&](uint64_t frame, const FrameSums& sums) {
        summary.samples = sums.samples();
        if (o.longRender.resume) removeStaleTemporaries(file(frame));
        if (writesSums(o)) {
            writeAccumulation(file(frame), render.header(), sums);
        } else {
            auto metadata = metadataOf(render.header(), frame, sums.samples(),
                                       cameraText(job.sequence.camera(frame, job.settings.extent)));
            if (const auto jitter = jitterOf(job.settings, frame, header.plan.samples))
                metadata[jitterAttribute] = jitterText(*jitter);
            writeFrame(job, frame, formatOf(render.header()), sums.means(), metadata);
        }
        if (o.dump.empty()) return;
        if (!frames.hasLaunched()) return log::warn("nothing was rendered: there is nothing to dump");
        writeDump(file(frame), frames.dump(o.dump));
    };
    const auto preview = [&](const FrameSums& sums) {
        PictureFormat format = formatOf(render.header());
        format.layers.clear();
        writePicture(previewFile(file(0)), format, sums.means(), {});
    };
    summary.complete = render.run({.progress = [&](uint64_t samples) { progress.show(samples); },
                                   .finish = finish,
                                   .preview = preview,
                                   .isThere = [&](uint64_t frame) { return fs::exists(file(frame)); }});
    summary.blocksFinished = render.blocksFinished();
    summary.framesFinished = render.framesFinished();
    summary.framesToDo = render.framesToDo();
    summary.timings.renderSeconds = render.renderSeconds();
    summary.counts = renderer.counts();
    if (frames.hasLaunched()) summary.lastFrame = sumByName(frames.passTimes());
}

}  // namespace limpid::cli
