// `limpid render` when frames build on each other: denoisers, and means kept on the device.
#include "base/clock.h"
#include "base/log.h"
#include "cli/console/interrupt.h"
#include "cli/console/progress.h"
#include "cli/render/picture_output.h"
#include "cli/render/render_job.h"
#include "renderer/frame/camera_text.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/long/render_identity.h"

namespace limpid::cli {
namespace {

std::map<std::string, std::string> metadataOf(const RenderJob& job, uint64_t frame, uint64_t samples) {
    const CameraParams camera = job.sequence.camera(frame, job.settings.extent);
    std::map<std::string, std::string> metadata{
        {"limpid.version", LIMPID_VERSION},
        {"limpid.scene", std::filesystem::path(job.options.scene.source.scene).filename().string()},
        {"limpid.integrator", std::string(nameOf(job.settings.pipeline.integrator))},
        {"limpid.denoiser", std::string(nameOf(job.settings.pipeline.denoiser))},
        {"limpid.samples", std::to_string(samples)},
        {"limpid.seed", std::to_string(job.settings.seed)},
        {"limpid.device", job.device.info().name},
        {"limpid.driver", job.device.info().driver},
        {cameraAttribute, cameraText(camera)}};
    // A mean over frames has no jitter of its own.
    const bool mean = job.settings.pipeline.accumulates();
    if (const auto jitter = mean ? std::nullopt : jitterOf(job.settings, frame, samples))
        metadata[jitterAttribute] = jitterText(*jitter);
    return metadata;
}

}  // namespace

void renderSuccessiveFrames(const RenderJob& job, RenderSummary& summary) {
    const RenderOptions& o = job.options;
    const FramePattern output(o.output);
    const PictureFormat format{chosenLayers(o), o.floatExr, o.exposure, image::parseToneCurve(o.toneCurve),
                               !job.settings.pipeline.needsExposure()};
    FrameRenderer renderer(job.device, job.scene, job.settings, samplesOf(o));
    Progress progress("frames", static_cast<uint64_t>(job.frames));
    const Clock::time_point start = Clock::now();
    PassTimes times;
    summary.framesToDo = static_cast<uint64_t>(job.frames);
    for (uint64_t frame = 0; frame < summary.framesToDo; ++frame) {
        renderer.render(job.sequence.moment(frame, job.settings.extent));
        const RenderedLayers layers = renderer.download();
        summary.lastFrame = sumByName(renderer.passTimes());
        times.add(summary.lastFrame);
        const std::filesystem::path file = output.format(static_cast<int>(frame));
        writeFrame(job, frame, format, layers, metadataOf(job, frame, layers.samples));
        if (!o.dump.empty()) writeDump(file, renderer.dump(o.dump));
        summary.samples = layers.samples;
        progress.show(++summary.framesFinished);
        if (interrupted()) break;
    }
    summary.complete = summary.framesFinished == summary.framesToDo;
    summary.medians = times.medians();
    summary.timings.renderSeconds = std::chrono::duration<double>(Clock::now() - start).count();
    const RenderCounters counters = renderer.counters();
    summary.counts = {.rays = counters.rays, .rejected = counters.rejected};
    if (!job.settings.pipeline.accumulates()) summary.disocclusion = renderer.disocclusionCounts();
}

}  // namespace limpid::cli
