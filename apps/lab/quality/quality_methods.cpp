#include "lab/quality/quality_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ranges>
#include <span>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "denoise/api/denoiser.h"
#include "renderer/frame/parameters.h"
#include "renderer/frame/presets.h"

namespace limpid::cli {
namespace {

constexpr std::string_view presetWord = "preset=";

/// SVGF as others have it, without each thing that Limpid adds to the paper, and with former defaults.
constexpr std::array svgfSteps{"preset=svgf-paper",    "preset=svgf-cis565",
                               "svgf.antilag=0",       "svgf.alpha=0.15,svgf.alpha_moments=0.2",
                               "svgf.antilag_noise=3", "svgf.antilag_pixel=1000",
                               "svgf.boost=off",       "svgf.blur_levels=10",
                               "svgf.wide=on",         "svgf.separate=off",
                               "svgf.reflections=off", "pathtrace.through_mirrors=off",
                               "svgf.alpha_shown=1"};

std::vector<std::string> wordsOf(const std::string& variant) {
    std::vector<std::string> words;
    std::istringstream stream(variant);
    for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
    if (words.empty()) throw UsageError("--variant names no parameter");
    return words;
}

/// Whether a word of a variant is about this pipeline: a parameter of its group, or a preset for it.
bool isAbout(const std::string& word, const std::string& group) {
    if (!word.starts_with(presetWord)) return word.starts_with(group + ".");
    const std::string_view preset = std::string_view(word).substr(presetWord.size());
    return std::ranges::find(findPreset(preset).pipelines, group) != findPreset(preset).pipelines.end();
}

const std::string& pipelineOf(const std::vector<std::string>& words,
                              const std::vector<std::string>& pipelines) {
    for (const std::string& pipeline : pipelines | std::views::reverse) {
        if (std::ranges::any_of(words, [&](const std::string& word) { return isAbout(word, pipeline); }))
            return pipeline;
    }
    return pipelines.back();
}

RenderSettings ofPipeline(RenderSettings settings, const std::string& name) {
    settings.pipeline = parsePipeline(name);
    if (!settings.pipeline.denoiser) throw UsageError(fmt::format("--pipeline {} does not denoise", name));
    return settings;
}

/// Jitter stays as the references have it.
void applyPresetTo(RenderSettings& settings, const std::string& preset) {
    pipelineFor(std::span(&preset, 1), settings.pipeline.name(), "");
    const Jitter jitter = settings.jitter;
    applyPreset(settings, preset);
    settings.jitter = jitter;
}

QualityMethod variantOf(const std::string& variant, const std::vector<std::string>& pipelines,
                        const RenderSettings& common) {
    const std::vector<std::string> words = wordsOf(variant);
    QualityMethod method{variant, ofPipeline(common, pipelineOf(words, pipelines))};
    for (const std::string& word : words) {
        if (word.starts_with(presetWord))
            applyPresetTo(method.settings, word.substr(presetWord.size()));
        else
            assign(method.settings, word);
    }
    return method;
}

}  // namespace

std::vector<QualityMethod> methodsOf(const MethodChoice& choice, RenderSettings common) {
    std::vector<QualityMethod> methods;
    for (const std::string& pipeline : choice.pipelines)
        methods.push_back({pipeline, ofPipeline(common, pipeline)});
    for (const std::string& variant : choice.variants)
        methods.push_back(variantOf(variant, choice.pipelines, common));
    if (!choice.steps) return methods;
    for (const char* step : svgfSteps) methods.push_back(variantOf(step, {"svgf"}, common));
    return methods;
}

}  // namespace limpid::cli
