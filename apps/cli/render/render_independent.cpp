// `limpid render` with the path tracer and no denoiser: stills, and sequences whose frames are independent.
#include "base/error.h"
#include "base/files/file.h"
#include "base/log.h"
#include "cli/cluster/session.h"
#include "cli/console/interrupt.h"
#include "cli/console/progress.h"
#include "cli/render/picture_output.h"
#include "cli/render/render_job.h"
#include "cli/render/render_sampled.h"
#include "renderer/frame/camera_text.h"
#include "renderer/long/long_render.h"
#include "renderer/long/render_identity.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds previewEvery{3};

/// A preview that cannot be written is no reason to lose the render.
void writePreview(const fs::path& output, PictureFormat format, const FrameSums& sums) try {
    format.layers.clear();
    writePicture(previewFile(output), format, sums.means(), {});
} catch (const OutputError& fault) {
    log::warn("--preview: {}", fault.what());
}

}  // namespace

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

void writeSampled(const RenderJob& job, const AccumulationHeader& header, uint64_t frame,
                  const FrameSums& sums, FrameRenderer& renderer) {
    const RenderOptions& o = job.options;
    const fs::path file = FramePattern(o.output).format(static_cast<int>(frame));
    if (o.longRender.resume) removeStaleTemporaries(file);
    if (writesSums(o)) {
        writeAccumulation(file, header, sums);
    } else {
        const std::string camera = cameraText(job.sequence.camera(frame, job.settings.extent));
        writeFrame(job, frame, formatOf(header), sums.means(),
                   metadataOf(header, frame, sums.samples(), camera));
    }
    if (o.dump.empty()) return;
    if (!renderer.hasLaunched()) return log::warn("nothing was rendered: there is nothing to dump");
    writeDump(file, renderer.dump(o.dump));
}

void renderIndependentFrames(const RenderJob& job, RenderSummary& summary) {
    if (ranks()) return renderSharedFrames(job, summary);
    const RenderOptions& o = job.options;
    const AccumulationHeader header = headerOf(job);
    const FramePattern output(o.output);
    FrameRenderer frames(job.device, job.scene, job.settings, header.plan.samples);
    BlockRenderer renderer(frames, header.plan);
    LongRender render(renderer, job.sequence, header);
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
        writeSampled(job, render.header(), frame, sums, frames);
    };
    const auto preview = [&](const FrameSums& sums) {
        writePreview(file(0), formatOf(render.header()), sums);
    };
    summary.complete = render.run({.progress = [&](uint64_t samples) { progress.show(samples); },
                                   .finish = finish,
                                   .preview = preview,
                                   .isThere = [&](uint64_t frame) { return fs::exists(file(frame)); }});
    summary.lostState = render.lostState();
    summary.blocksFinished = render.blocksFinished();
    summary.framesFinished = render.framesFinished();
    summary.framesToDo = render.framesToDo();
    summary.timings.renderSeconds = render.renderSeconds();
    summary.counts = renderer.counts();
    if (frames.hasLaunched()) summary.lastFrame = sumByName(frames.passTimes());
}

}  // namespace limpid::cli
