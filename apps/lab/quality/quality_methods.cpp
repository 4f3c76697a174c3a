#include "lab/quality/quality_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "denoise/api/denoiser.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"

namespace limpid::cli {
namespace {

constexpr std::string_view presetWord = "preset=";

/// Standard SVGF, our SVGF without each of its extensions to the paper, and with former defaults.
constexpr std::array svgfSteps{"preset=svgf-paper",
                               "preset=svgf-cis565",
                               "svgf.antilag=0",
                               "svgf.alpha=0.15,svgf.alpha_moments=0.2",
                               "svgf.antilag_around=off",
                               "svgf.antilag=16,svgf.antilag_noise=1.5,svgf.antilag_pixel=1.5",
                               "svgf.antilag_pixel=1000",
                               "svgf.boost=off",
                               "svgf.sample_variance=off",
                               "svgf.blur_levels=10",
                               "svgf.mean_levels=0",
                               "svgf.damp_outliers=off",
                               "svgf.wide=on",
                               "svgf.separate=off",
                               "svgf.reflections=off",
                               "svgf.lobe_test=0",
                               "svgf.phi_roughness=0",
                               "pathtrace.through_mirrors=off",
                               "pathtrace.through_glass=off",
                               "svgf.stabilisation_alpha=1",
                               "svgf.fireflies=0",
                               "svgf.young_radius=0"};

std::vector<std::string> wordsOf(const std::string& variant) {
    std::vector<std::string> words;
    std::istringstream stream(variant);
    for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
    if (words.empty()) throw UsageError("--variant names no parameter");
    return words;
}

/// True if a word of a variant refers to this denoiser: a parameter of its group, or one of its presets.
bool isAbout(const std::string& word, const std::string& group) {
    if (!word.starts_with(presetWord)) return word.starts_with(group + ".");
    const std::string_view preset = std::string_view(word).substr(presetWord.size());
    const std::vector<std::string>& denoisers = findPreset(preset).denoisers;
    return std::ranges::find(denoisers, group) != denoisers.end();
}

/// True if a word of a variant is a parameter that this denoiser reads, as nano does those of svgf. All read
/// those of anti-aliasing.
bool isReadBy(const std::string& word, const std::string& name) {
    const denoise::Denoiser* const denoiser = denoise::findDenoiser(name);
    const std::string_view group = std::string_view(word).substr(0, word.find('.'));
    return denoiser && group != "taa" && std::ranges::find(denoiser->groups, group) != denoiser->groups.end();
}

/// The last one that a word refers to, else the last one that reads a word, else the last one.
const std::string& denoiserOf(const std::vector<std::string>& words,
                              const std::vector<std::string>& denoisers) {
    for (const auto refers : {isAbout, isReadBy}) {
        const auto found =
            std::find_if(denoisers.rbegin(), denoisers.rend(), [&](const std::string& denoiser) {
                return std::ranges::any_of(words,
                                           [&](const std::string& word) { return refers(word, denoiser); });
            });
        if (found != denoisers.rend()) return *found;
    }
    return denoisers.back();
}

RenderSettings withDenoiser(RenderSettings settings, const std::string& name, const MethodChoice& choice) {
    settings.pipeline = parsePipeline(nameOf(settings.pipeline.integrator), name);
    if (!settings.pipeline.denoiser) throw UsageError("--denoiser none: it is scored anyway, as 'noisy'");
    settings.jitter = choice.jitter.value_or(defaultJitter(settings.pipeline, choice.samples));
    return settings;
}

void applyPresetTo(RenderSettings& settings, const std::string& preset) {
    pipelineFor(
        preset,
        {std::string(nameOf(settings.pipeline.integrator)), std::string(nameOf(settings.pipeline.denoiser))},
        {});
    applyPreset(settings, preset);
}

QualityMethod variantOf(const std::string& variant, const MethodChoice& choice,
                        const RenderSettings& common) {
    const std::vector<std::string> words = wordsOf(variant);
    QualityMethod method{variant, withDenoiser(common, denoiserOf(words, choice.denoisers), choice)};
    for (const std::string& word : words) {
        if (word.starts_with(presetWord))
            applyPresetTo(method.settings, word.substr(presetWord.size()));
        else
            assign(method.settings, word);
    }
    method.settings.jitter = choice.jitter.value_or(method.settings.jitter);
    return method;
}

}  // namespace

std::vector<QualityMethod> methodsOf(const MethodChoice& choice, RenderSettings common) {
    std::vector<QualityMethod> methods;
    for (const std::string& denoiser : choice.denoisers)
        methods.push_back({denoiser, withDenoiser(common, denoiser, choice)});
    for (const std::string& variant : choice.variants) methods.push_back(variantOf(variant, choice, common));
    if (!choice.steps) return methods;
    for (const char* step : svgfSteps)
        methods.push_back(variantOf(step, {.denoisers = {"svgf"}, .jitter = choice.jitter}, common));
    return methods;
}

}  // namespace limpid::cli
