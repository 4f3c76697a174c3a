#include "renderer/method/presets.h"

#include <algorithm>

#include "base/error.h"
#include "renderer/method/parameters.h"

namespace limpid {
namespace {

const std::vector<std::string> lightIntegrators{"path", "direct", "ao"};

/// Adds what no source of a denoiser has: layers of what mirrors and glass show, and Sobol' points.
std::vector<std::string> asInSources(std::vector<std::string> own) {
    for (const char* assignment :
         {"pathtrace.through_mirrors=off", "pathtrace.through_glass=off", "pathtrace.sampler_sobol=off"})
        own.emplace_back(assignment);
    return own;
}

Preset historyTrackingCourse() {
    return {
        .name = "history-tracking-course",
        .help =
            "a course's projects \"History tracking\" and \"Denoising via the A-Trous algorithm\": means "
            "that follow each pixel, restarted from grey, then five levels of an a-trous filter. "
            "Differences: "
            "the spline is symmetric; the motion of objects is followed and changes the expected distance; "
            "directly visible lights and sky are added at the end, unfiltered",
        .integrators = lightIntegrators,
        .denoisers = {"atrous", "temporal"},
        .jitter = Jitter::Off,
        .assignments = asInSources({"temporal.normal=0.95",       "temporal.depth=0.15",
                                    "temporal.relative=off",      "temporal.search=off",
                                    "temporal.demodulate=off",    "temporal.max_history=0",
                                    "temporal.grey_restart=on",   "temporal.grey=0.5",
                                    "temporal.grey_misses=on",    "temporal.identity=off",
                                    "atrous.temporal=on",         "atrous.levels=5",
                                    "atrous.normal_factor=0.003", "atrous.depth_factor=0.007",
                                    "atrous.sample_target=0",     "atrous.plane=off",
                                    "atrous.demodulate=on",       "atrous.min_albedo=0.1",
                                    "atrous.color_factor=0",      "taa.frames=1"})};
}

Preset ambientOcclusionTutorial() {
    return {.name = "ambient-occlusion-tutorial",
            .help =
                "C. Wyman's \"DirectX Raytracing, Tutorial 6\": G-buffer, one ambient-occlusion ray per "
                "pixel and frame, a running mean that restarts when anything changes. Difference: primary "
                "visibility is traced, not rasterised",
            .integrators = {"ao"},
            .denoisers = {"none", "temporal", "atrous", "svgf", "nano", "film", "kpcn"},
            .jitter = Jitter::Off,
            .assignments = {"ao.rays=1", "ao.radius=0.05", "pathtrace.sampler_sobol=off"}};
}

Preset svgfOfCis565() {
    return {
        .name = "svgf-cis565",
        .help =
            "SVGF as in \"Path Tracing Denoising\", a final project of the course CIS 565: one signal "
            "with its albedo, weights by distances of points and of normals in world units. "
            "Differences: the first step is 1 pixel instead of 2, variances are those of a weighted mean, "
            "and the search for history in 3x3 pixels stays on",
        .integrators = lightIntegrators,
        .denoisers = {"svgf"},
        .jitter = Jitter::Off,
        .assignments = asInSources({"svgf.separate=off",
                                    "svgf.demodulate=off",
                                    "svgf.alpha=0.2",
                                    "svgf.alpha_moments=0.2",
                                    "svgf.normal_test=0.995",
                                    "svgf.depth_test=0.1",
                                    "svgf.relative=off",
                                    "svgf.antilag=0",
                                    "svgf.fireflies=0",
                                    "svgf.young_radius=0",
                                    "svgf.stabilisation_alpha=1",
                                    "svgf.levels=5",
                                    "svgf.history_level=1",
                                    "svgf.wide=on",
                                    "svgf.phi_color=0.7",
                                    "svgf.phi_normal=0.2",
                                    "svgf.phi_depth=0.35",
                                    "svgf.boost=off",
                                    "svgf.sample_variance=off",
                                    "svgf.blur_levels=10",
                                    "svgf.mean_levels=0",
                                    "svgf.damp_outliers=off",
                                    "svgf.position=on",
                                    "taa.frames=1"})};
}

Preset kpcnOfCis565() {
    return {
        .name = "kpcn-cis565",
        .help =
            "the network of \"Path Tracing Denoising\", a final project of the course CIS 565: trained for "
            "10 epochs on 32 samples, with the inputs, rates and batches that it names, and no filter after "
            "its kernels. Difference: it was trained on Limpid's random rooms and still lifes",
        .integrators = lightIntegrators,
        .denoisers = {"kpcn"},
        .jitter = Jitter::Pixel,
        .assignments = asInSources({"kpcn.cis565=on", "kpcn.levels=0", "kpcn.errors=0"})};
}

Preset jitterCameraTutorial() {
    return {.name = "jitter-camera-tutorial",
            .help =
                "NVIDIA's Vulkan ray tracing tutorial \"Jitter camera\": one ray per pixel and frame through "
                "a random point of the pixel, the first through its centre, a TEA seed per pixel and frame "
                "with a linear congruential generator, a running mean of the frames. Difference: with "
                "--samples-per-launch only the very first sample goes through the centre, not all of frame 0",
            .integrators = {"path", "direct", "ao", "gbuffer"},
            .denoisers = {"none"},
            .jitter = Jitter::Pixel,
            .progressive = true,
            .assignments = {"pathtrace.sampler_tea=on", "pathtrace.sampler_sobol=off"}};
}

Preset svgfOfThePaper() {
    return {.name = "svgf-paper",
            .help =
                "Schied et al., \"Spatiotemporal Variance-Guided Filtering\", HPG 2017, without Limpid's "
                "extensions",
            .integrators = lightIntegrators,
            .denoisers = {"svgf"},
            .jitter = Jitter::Off,
            .assignments = asInSources({"svgf.alpha=0.2",
                                        "svgf.reflections=off",
                                        "svgf.wide=on",
                                        "svgf.alpha_moments=0.2",
                                        "svgf.antilag=0",
                                        "svgf.fireflies=0",
                                        "svgf.young_radius=0",
                                        "svgf.stabilisation_alpha=1",
                                        "svgf.levels=5",
                                        "svgf.history_level=1",
                                        "svgf.phi_normal=128",
                                        "svgf.phi_depth=1",
                                        "svgf.boost=off",
                                        "svgf.blur_levels=10",
                                        "svgf.mean_levels=0",
                                        "svgf.damp_outliers=off",
                                        "svgf.lobe_test=0",
                                        "svgf.phi_roughness=0",
                                        "svgf.sample_variance=off",
                                        "taa.frames=1"})};
}

std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += " " + word;
    return text;
}

bool contains(const std::vector<std::string>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

void checkIsFor(const Preset& preset, const char* option, std::string_view name,
                const std::vector<std::string>& names) {
    if (contains(names, name)) return;
    throw UsageError("--preset " + preset.name + ": is not for " + option + " " + std::string(name) +
                     ", but for" + listed(names));
}

void setDefault(RenderSettings& settings, const Assignment& parameter) {
    for (const ParamGroup& group : paramGroups()) {
        if (group.name != parameter.group) continue;
        const auto info = std::ranges::find(group.infos, parameter.name, &ParamInfo::name);
        if (info != group.infos.end()) group.set(settings, info->name, toString(info->defaultValue));
    }
}

}  // namespace

bool Preset::isFor(const Pipeline& pipeline) const {
    return contains(integrators, nameOf(pipeline.integrator)) && isForDenoiser(nameOf(pipeline.denoiser));
}

bool Preset::isForDenoiser(std::string_view denoiser) const {
    return contains(denoisers, denoiser);
}

Pipeline Preset::pipeline() const {
    return parsePipeline(integrators.front(), denoisers.front());
}

const std::vector<Preset>& presets() {
    static const std::vector<Preset> all{ambientOcclusionTutorial(),
                                         historyTrackingCourse(),
                                         jitterCameraTutorial(),
                                         kpcnOfCis565(),
                                         svgfOfCis565(),
                                         svgfOfThePaper()};
    return all;
}

const Preset& findPreset(std::string_view name) {
    std::vector<std::string> names;
    for (const Preset& preset : presets()) {
        if (preset.name == name) return preset;
        names.push_back(preset.name);
    }
    throw UsageError("there is no preset '" + std::string(name) + "'; the presets are" + listed(names));
}

void applyPreset(RenderSettings& settings, std::string_view name) {
    if (name.empty()) return;
    const Preset& preset = findPreset(name);
    settings.jitter = preset.jitter;
    for (const std::string& text : preset.assignments) assign(settings, text);
}

void applyOnlyPreset(RenderSettings& settings, std::string_view name) {
    for (const Preset& other : presets())
        for (const std::string& text : other.assignments) setDefault(settings, parseAssignment(text));
    applyPreset(settings, name);
}

Pipeline pipelineFor(std::string_view presetName, const PipelineChoice& asked, const Pipeline& otherwise) {
    const Preset* const preset = presetName.empty() ? nullptr : &findPreset(presetName);
    const Pipeline offered = preset ? preset->pipeline() : otherwise;
    std::string integrator = asked.integrator, denoiser = asked.denoiser;
    if (integrator.empty()) integrator = nameOf(offered.integrator);
    if (denoiser.empty()) denoiser = nameOf(offered.denoiser);
    const denoise::Denoiser* const wanted = parseDenoiser(denoiser);
    if (!preset && wanted && !canBeDenoised(parseIntegrator(integrator), *wanted)) {
        if (asked.denoiser.empty())
            denoiser = nameOf(nullptr);
        else if (asked.integrator.empty())
            integrator = nameOf(integratorFor(*wanted, parseIntegrator(integrator)));
    }
    if (preset) {
        checkIsFor(*preset, "--integrator", nameOf(parseIntegrator(integrator)), preset->integrators);
        checkIsFor(*preset, "--denoiser", nameOf(parseDenoiser(denoiser)), preset->denoisers);
    }
    return parsePipeline(integrator, denoiser);
}

}  // namespace limpid
