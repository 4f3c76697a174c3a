#include "lab/quality/report/quality_json.h"

#include <cmath>

#include "lab/quality/report/quality_ranking.h"

namespace limpid::cli {
namespace {

using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

/// HDR-FLIP is too slow to measure here.
bool measured(const image::Metric& metric) {
    return metric.name != "hdr_flip";
}

Json frameJson(const MethodQuality& method, size_t index) {
    const image::FrameScores& scores = method.scores[index];
    Json frame{{"frame", scores.frame}};
    for (const image::Metric& metric : image::sequenceMetrics()) {
        if (measured(metric)) frame[std::string(metric.name)] = number(metric.of(scores));
    }
    if (index < method.denoisingMs.size()) frame["denoising_ms"] = method.denoisingMs[index];
    frame["invalid_pixels"] = scores.invalidPixels;
    return frame;
}

Json methodJson(const MethodQuality& method) {
    Json object{{"method", method.name}};
    for (const image::Metric& metric : image::sequenceMetrics()) {
        if (!measured(metric)) continue;
        const std::optional<image::Worst> worst = image::worstOf(metric, method.scores);
        object[std::string(metric.name)] = {
            {"mean", number(image::meanOf(metric, method.scores))},
            {"worst", number(worst ? std::optional(worst->value) : std::nullopt)},
            {"worst_frame", worst ? worst->frame : -1}};
    }
    object["median_ms"] = method.medianMs;
    object["denoising_ms"] = number(denoisingMs(method));
    object["denoising_bytes_per_pixel"] = number(bytesPerPixel(method));
    object["frames"] = Json::array();
    for (size_t i = 0; i < method.scores.size(); ++i) object["frames"].push_back(frameJson(method, i));
    return object;
}

Json sequenceJson(const MeasuredSequence& measuredSequence) {
    const QualitySequence& sequence = measuredSequence.sequence;
    const SequenceQuality& quality = measuredSequence.quality;
    Json object{{"name", sequence.name},
                {"scene", sequence.scene},
                {"camera_path", sequence.cameraPath},
                {"environment", sequence.environment},
                {"triangles", measuredSequence.triangles},
                {"first_frame", sequence.frames.first},
                {"frames", sequence.frames.count},
                {"exposure", quality.exposure},
                {"reference_samples", sequence.referenceSamples},
                {"reference_psnr", number(quality.referencePsnr)},
                {"methods", Json::array()}};
    for (const MethodQuality& method : quality.methods) object["methods"].push_back(methodJson(method));
    return object;
}

Json rankJson(const MethodRank& rank) {
    return {{"method", rank.name},
            {"flip", rank.flip},
            {"rank", rank.rank},
            {"psnr_gain", number(rank.gain)},
            {"flicker", number(rank.flicker)},
            {"denoising_ms", number(rank.denoisingMs)},
            {"denoising_bytes_per_pixel", number(rank.bytesPerPixel)},
            {"best", rank.best}};
}

}  // namespace

Json qualityJson(const QualityRun& run) {
    Json object{{"version", run.version},      {"command", run.command},  {"device", run.device},
                {"driver", run.driver},        {"tracer", run.tracer},    {"width", run.extent.width},
                {"height", run.extent.height}, {"samples", run.samples},  {"scenes", Json::array()},
                {"ranking", Json::array()},    {"skipped", Json::array()}};
    for (const MeasuredSequence& sequence : run.sequences) object["scenes"].push_back(sequenceJson(sequence));
    for (const MethodRank& rank : rankMethods(run)) object["ranking"].push_back(rankJson(rank));
    for (const SkippedSequence& skipped : run.skipped)
        object["skipped"].push_back({{"name", skipped.name}, {"reason", skipped.reason}});
    return object;
}

}  // namespace limpid::cli
