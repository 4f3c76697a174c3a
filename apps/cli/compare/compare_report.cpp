#include "cli/compare/compare_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace limpid::cli {
namespace {

using image::FrameScores;
using image::Metric;
using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) {
    return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json exposuresJson(const std::optional<image::HdrFlipExposures>& exposures) {
    if (!exposures) return nullptr;
    return {{"start", exposures->start}, {"stop", exposures->stop}, {"count", exposures->count}};
}

const char* nameOf(image::MotionSource source) {
    switch (source) {
        case image::MotionSource::Reference:
            return "reference";
        case image::MotionSource::Test:
            return "test";
        case image::MotionSource::None:
            break;
    }
    return "none";
}

/// Returns the motion of all frames after the first: one name, or "mixed". Empty if there is only one frame.
std::string motionOf(std::span<const FrameScores> frames) {
    std::string all;
    for (const FrameScores& frame : frames) {
        if (!frame.motion) continue;
        const std::string name = nameOf(*frame.motion);
        if (!all.empty() && all != name) return "mixed";
        all = name;
    }
    return all;
}

uint64_t invalidPixels(std::span<const FrameScores> frames) {
    uint64_t sum = 0;
    for (const FrameScores& frame : frames) sum += frame.invalidPixels;
    return sum;
}

Json frameJson(const FrameScores& frame) {
    Json json;
    json["frame"] = frame.frame;
    for (const Metric& metric : image::sequenceMetrics())
        json[std::string(metric.name)] = number(metric.of(frame));
    json["hdr_exposures"] = exposuresJson(frame.hdrExposures);
    json["flicker_pixels"] = frame.motion ? Json(frame.flickerPixels) : Json(nullptr);
    json["motion"] = frame.motion ? Json(nameOf(*frame.motion)) : Json(nullptr);
    json["invalid_pixels"] = frame.invalidPixels;
    return json;
}

size_t widthOf(const Metric& metric) {
    return std::max<size_t>(11, metric.name.size() + 2);
}

/// Formats a cell of the table: as wide as its column, "-" if there is no value.
std::string cell(const Metric& metric, std::optional<double> value) {
    const size_t width = widthOf(metric);
    if (!value) return fmt::format("{:>{}}", "-", width);
    if (metric.name == "psnr") return fmt::format("{:>{}.4f}", *value, width);
    if (metric.name == "relmse") return fmt::format("{:>{}.5g}", *value, width);
    return fmt::format("{:>{}.6f}", *value, width);
}

std::string row(const std::string& head, const auto& cellOf) {
    std::string text = fmt::format("{:>8}", head);
    for (const Metric& metric : image::sequenceMetrics()) text += cellOf(metric);
    return text + "\n";
}

std::string motionLine(const std::string& motion) {
    if (motion.empty()) return "-";
    return motion == "none" ? "none (every pixel taken as still)" : motion;
}

}  // namespace

std::string pictureJson(const image::Comparison& c, const std::optional<image::HdrFlip>& hdr) {
    Json json;
    json["psnr"] = number(c.psnr);
    json["ssim"] = c.ssim;
    json["relmse"] = c.relMse;
    json["flip"] = c.flip;
    json["hdr_flip"] = hdr ? Json(hdr->value) : Json(nullptr);
    json["hdr_exposures"] = exposuresJson(hdr ? std::optional(hdr->exposures) : std::nullopt);
    json["exposure"] = c.exposure;
    json["width"] = c.flipMap.width;
    json["height"] = c.flipMap.height;
    json["invalid_pixels"] = c.invalidPixels;
    return json.dump() + "\n";
}

std::string pictureTable(const image::Comparison& c, const std::optional<image::HdrFlip>& hdr) {
    std::string text;
    text += fmt::format("psnr      {:>12.4f} dB\n", c.psnr);
    text += fmt::format("ssim      {:>12.6f}\n", c.ssim);
    text += fmt::format("relmse    {:>12.6g}\n", c.relMse);
    text += fmt::format("flip      {:>12.6f}\n", c.flip);
    if (hdr) {
        text += fmt::format("hdr_flip  {:>12.6f}  ({} exposures from {:+.4f} to {:+.4f} stops)\n", hdr->value,
                            hdr->exposures.count, hdr->exposures.start, hdr->exposures.stop);
    }
    text += fmt::format("exposure  {:>+12.4f} stops\n", c.exposure);
    text += fmt::format("size      {:>12}\n", fmt::format("{}x{}", c.flipMap.width, c.flipMap.height));
    text += fmt::format("invalid   {:>12} pixels\n", c.invalidPixels);
    return text;
}

std::string sequenceJson(std::span<const FrameScores> frames, const SequenceFacts& facts) {
    Json json;
    json["frames"] = Json::array();
    for (const FrameScores& frame : frames) json["frames"].push_back(frameJson(frame));
    for (const Metric& metric : image::sequenceMetrics()) {
        const std::string name(metric.name);
        json["mean"][name] = number(image::meanOf(metric, frames));
        const auto worst = image::worstOf(metric, frames);
        json["worst"][name] =
            worst ? Json{{"value", number(worst->value)}, {"frame", worst->frame}} : Json(nullptr);
    }
    const std::string motion = motionOf(frames);
    json["motion"] = motion.empty() ? Json(nullptr) : Json(motion);
    json["exposure"] = facts.exposure;
    json["width"] = facts.width;
    json["height"] = facts.height;
    json["invalid_pixels"] = invalidPixels(frames);
    return json.dump() + "\n";
}

std::string sequenceTable(std::span<const FrameScores> frames, const SequenceFacts& facts) {
    std::string text =
        row("frame", [](const Metric& m) { return fmt::format("{:>{}}", m.name, widthOf(m)); });
    for (const FrameScores& frame : frames) {
        text += row(std::to_string(frame.frame), [&](const Metric& m) { return cell(m, m.of(frame)); });
    }
    text += row("mean", [&](const Metric& m) { return cell(m, image::meanOf(m, frames)); });
    text += row("worst", [&](const Metric& m) {
        const auto worst = image::worstOf(m, frames);
        return cell(m, worst ? std::optional(worst->value) : std::nullopt);
    });
    text += row("at frame", [&](const Metric& m) {
        const auto worst = image::worstOf(m, frames);
        return fmt::format("{:>{}}", worst ? std::to_string(worst->frame) : "-", widthOf(m));
    });
    text += fmt::format("exposure  {:+.4f} stops\n", facts.exposure);
    text += fmt::format("size      {}x{}\n", facts.width, facts.height);
    text += fmt::format("motion    {}\n", motionLine(motionOf(frames)));
    text += fmt::format("invalid   {} pixels\n", invalidPixels(frames));
    return text;
}

}  // namespace limpid::cli
