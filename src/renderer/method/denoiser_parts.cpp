#include "renderer/method/denoiser_parts.h"

#include <span>
#include <vector>

#include "renderer/method/parameters.h"

namespace limpid {
namespace {

/// What switches the parts of one denoiser off, in the order of denoiserParts. Empty: it lacks that part.
struct Switches {
    std::string_view denoiser;
    std::array<std::vector<std::string_view>, denoiserParts.size()> assignments;
};

std::span<const std::string_view> switchesOf(const denoise::Denoiser* denoiser, size_t part) {
    static const std::vector<std::string_view> singleFrames{"svgf.alpha=1", "svgf.alpha_moments=1",
                                                            "svgf.antilag=0", "svgf.stabilisation_alpha=1",
                                                            "taa.frames=1"};
    static const std::vector<Switches> all{
        {"svgf", {{singleFrames, {"svgf.levels=0"}, {"svgf.demodulate=off"}}}},
        {"nano", {{singleFrames, {"svgf.levels=0", "nano.strength=0"}, {"svgf.demodulate=off"}}}},
        {"film", {{singleFrames, {"svgf.levels=0", "film.strength=0"}, {"svgf.demodulate=off"}}}},
        {"atrous",
         {{{"atrous.temporal=off", "taa.frames=1"},
           {"atrous.levels=0"},
           {"atrous.demodulate=off", "temporal.demodulate=off"}}}},
        {"temporal", {{{"temporal.max_history=1", "taa.frames=1"}, {}, {"temporal.demodulate=off"}}}},
        // Dividing by an albedo of at least 1 changes nothing.
        {"bilateral", {{{}, {"bilateral.radius=0"}, {"bilateral.min_albedo=1"}}}},
    };
    for (const Switches& one : all)
        if (denoiser && one.denoiser == denoiser->name) return one.assignments[part];
    return {};
}

}  // namespace

bool hasPart(const denoise::Denoiser* denoiser, size_t part) {
    return !switchesOf(denoiser, part).empty();
}

RenderSettings withParts(const RenderSettings& settings, const DenoiserParts& parts) {
    RenderSettings result = settings;
    for (size_t part = 0; part < denoiserParts.size(); ++part) {
        if (parts.on[part]) continue;
        for (const std::string_view assignment : switchesOf(settings.pipeline.denoiser, part))
            assign(result, assignment);
        // Frames that are not averaged would shake.
        if (denoiserParts[part].name == "temporal" && result.jitter == Jitter::Frame)
            result.jitter = Jitter::Off;
    }
    return result;
}

}  // namespace limpid
