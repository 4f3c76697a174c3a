#include "cli/render/render_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/log.h"
#include "base/text/format.h"
#include "cli/cluster/session.h"
#include "cli/console/interrupt.h"
#include "cli/console/json_text.h"
#include "cli/console/progress.h"

namespace limpid::cli {
namespace {

nlohmann::json disocclusionJson(const denoise::DisocclusionCounts& counts) {
    return {{"nothing_hit", counts.nothingHit},
            {"off_screen", counts.offScreen},
            {"no_valid_tap", counts.noValidTap},
            {"rejected", counts.rejected}};
}

void warnOfLosses(const SampleCounts& counts) {
    if (counts.rejected > 0) log::warn("{} samples were NaN or infinite and count as black", counts.rejected);
    if (counts.clamped > 0) log::warn("{} means were beyond +-1e12 and were clamped", counts.clamped);
}

void warnOfRest(const RenderOptions& o, const RenderSummary& s) {
    if (s.framesToDo == 0 || (s.complete && s.samples == 0 && writesSums(o)))
        log::warn("shard {} is empty: there are fewer parts than shards", o.longRender.shard);
    if (s.complete) return;
    const bool kept = !o.longRender.checkpoint.empty() && !s.lostState;
    const char* const rest = kept ? "; --resume makes the rest" : "";
    const char* const why = interrupted() ? "interrupted" : "time is up";
    if (s.frames > 1) {
        log::warn("{}: {} of {} frames are finished{}", why, s.framesFinished, s.framesToDo, rest);
    } else {
        log::warn("{}: the picture has {} of {} samples{}", why, s.samples, samplesOf(o), rest);
    }
}

void warnOfNoProgress(const RenderOptions& o, const RenderSummary& s) {
    if (s.complete || s.blocksFinished > 0 || (o.longRender.checkpoint.empty() && !writesSums(o))) return;
    log::warn("not one block of {} samples was finished in that time, and only whole blocks are kept",
              std::min<uint64_t>(samplesOf(o), blockSamplesFor(samplesOf(o))));
}

/// With hundredths below a minute.
std::string timeText(double seconds) {
    return seconds < 60.0 ? fmt::format("{:.2f} s", seconds) : durationText(seconds);
}

}  // namespace

void reportRender(const RenderOptions& o, const gpu::Device& device, const RenderSummary& s,
                  const scene::Scene& scene, const scene::GpuScene& gpuScene) {
    warnOfLosses(s.counts);
    warnOfRest(o, s);
    warnOfNoProgress(o, s);
    const double megaRays =
        static_cast<double>(s.counts.rays) * 1e-6 / std::max(s.timings.renderSeconds, 1e-9);
    if (!s.piecesByProcess.empty() && !o.json)
        log::info("{}", describePieces(s.piecesByProcess, s.frames > 1 ? "frames" : "blocks of samples"));
    if (!o.json && s.frames > 1 && s.framesFinished == 0) {
        log::info("wrote nothing to {}: no frame is finished", o.output);
        return;
    }
    if (!o.json) {
        const std::string frames = s.frames > 1 ? fmt::format("{} frames of ", s.framesFinished) : "";
        log::info("wrote {}: {}{} of {}x{} in {}, {:.2f} million rays per second, on {}", o.output, frames,
                  countText(s.samples, "sample"), o.width, o.height, timeText(s.timings.renderSeconds),
                  megaRays, device.info().name);
        return;
    }
    nlohmann::json object{{"output", o.output},
                          {"integrator", nameOf(pipelineOf(o).integrator)},
                          {"denoiser", nameOf(pipelineOf(o).denoiser)},
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
                          {"last_frame_ms", s.lastFrame},
                          {"validation_messages", device.validationMessages()}};
    if (!s.piecesByProcess.empty()) object["pieces_by_process"] = s.piecesByProcess;
    if (!s.medians.empty()) object["median_ms"] = s.medians;
    if (s.disocclusion) object["disocclusion"] = disocclusionJson(*s.disocclusion);
    fmt::print("{}\n", jsonText(object));
}

}  // namespace limpid::cli
