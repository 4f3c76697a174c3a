#include "renderer/frame/presets.h"

#include <algorithm>

#include "base/error.h"
#include "renderer/frame/parameters.h"

namespace limpid {
namespace {

Preset historyTrackingCourse() {
    return {.name = "history-tracking-course",
            .help =
                "a course's projects \"History tracking\" and \"Denoising via the A-Trous algorithm\": means "
                "that follow each pixel, restarted from grey, then five levels of an a-trous filter. Not as "
                "there: the spline is symmetric, motion of objects is followed and changes the expected "
                "distance, and what is seen directly (lights, sky) is added at the end, unfiltered",
            .pipelines = {"atrous", "history"},
            .jitter = Jitter::Off,
            .assignments = {"history.normal=0.95",
                            "history.depth=0.15",
                            "history.relative=off",
                            "history.search=off",
                            "history.demodulate=off",
                            "history.max_history=0",
                            "history.grey_restart=on",
                            "history.grey=0.5",
                            "history.grey_misses=on",
                            "history.identity=off",
                            "atrous.history=on",
                            "atrous.levels=5",
                            "atrous.normal_factor=0.003",
                            "atrous.depth_factor=0.007",
                            "atrous.sample_target=0",
                            "atrous.plane=off",
                            "atrous.demodulate=on",
                            "atrous.color_factor=0",
                            "taa.frames=1",
                            "pathtrace.through_mirrors=off"}};
}

Preset ambientOcclusionTutorial() {
    return {.name = "ambient-occlusion-tutorial",
            .help =
                "C. Wyman's \"DirectX Raytracing, Tutorial 6\": G-buffer, one ambient-occlusion ray per "
                "pixel and frame, a running mean that starts anew when anything changes. Not as there: what "
                "the camera sees is traced and not rasterised",
            .pipelines = {"ao"},
            .jitter = Jitter::Off,
            .assignments = {"ao.rays=1", "ao.radius=0.05"}};
}

Preset svgfOfCis565() {
    return {.name = "svgf-cis565",
            .help =
                "SVGF as in \"Path Tracing Denoising\", a final project of the course CIS 565: one signal "
                "with its albedo, weights by distances of points and of normals in world units. Not as "
                "there: the first step is 1 pixel instead of 2, variances are those of a weighted mean",
            .pipelines = {"svgf"},
            .jitter = Jitter::Off,
            .assignments = {"svgf.separate=off",      "svgf.demodulate=off",
                            "svgf.alpha=0.2",         "svgf.alpha_moments=0.2",
                            "svgf.normal_test=0.995", "svgf.depth_test=0.1",
                            "svgf.relative=off",      "svgf.antilag=0",
                            "svgf.alpha_shown=1",     "svgf.levels=5",
                            "svgf.history_level=1",   "svgf.wide=on",
                            "svgf.phi_color=0.7",     "svgf.phi_normal=0.2",
                            "svgf.phi_depth=0.35",    "svgf.boost=off",
                            "svgf.blur_levels=10",    "svgf.position=on",
                            "taa.frames=1",           "pathtrace.through_mirrors=off"}};
}

Preset kpcnOfCis565() {
    return {
        .name = "kpcn-cis565",
        .help =
            "the network of \"Path Tracing Denoising\", a final project of the course CIS 565: trained for "
            "10 epochs on 32 samples, with the inputs, rates and batches that it names, and nothing after "
            "its kernels. Not as there: it sees the logarithm of diffuse light, and learnt from Limpid's "
            "random rooms and still lifes",
        .pipelines = {"kpcn"},
        .jitter = Jitter::Pixel,
        .assignments = {"kpcn.cis565=on", "kpcn.levels=0", "kpcn.errors=0", "pathtrace.through_mirrors=off"}};
}

Preset jitterCameraTutorial() {
    return {.name = "jitter-camera-tutorial",
            .help =
                "NVIDIA's Vulkan ray tracing tutorial \"Jitter camera\": one ray per pixel and frame through "
                "a random point of the pixel, the first through its centre, a TEA seed per pixel and frame "
                "with a linear congruential generator, a running mean of the frames. Not as there: with "
                "--samples-per-launch only the very first sample goes through the centre, not all of frame 0",
            .pipelines = {"path", "gbuffer", "ao"},
            .jitter = Jitter::Pixel,
            .progressive = true,
            .assignments = {"pathtrace.sampler_tea=on"}};
}

Preset svgfOfThePaper() {
    return {
        .name = "svgf-paper",
        .help =
            "Schied et al., \"Spatiotemporal Variance-Guided Filtering\", HPG 2017, without what Limpid adds "
            "to it",
        .pipelines = {"svgf"},
        .jitter = Jitter::Off,
        .assignments = {"svgf.alpha=0.2", "svgf.reflections=off", "svgf.wide=on", "svgf.alpha_moments=0.2",
                        "svgf.antilag=0", "svgf.alpha_shown=1", "svgf.levels=5", "svgf.history_level=1",
                        "svgf.phi_normal=128", "svgf.phi_depth=1", "svgf.boost=off", "svgf.blur_levels=10",
                        "taa.frames=1", "pathtrace.through_mirrors=off"}};
}

std::string listed(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += " " + word;
    return text;
}

}  // namespace

bool Preset::isFor(const Pipeline& pipeline) const {
    return std::ranges::find(pipelines, pipeline.name()) != pipelines.end();
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
    const Preset& preset = findPreset(name);
    settings.jitter = preset.jitter;
    for (const std::string& text : preset.assignments) assign(settings, text);
}

Pipeline pipelineFor(std::span<const std::string> presetNames, std::string_view asked,
                     std::string_view otherwise) {
    const std::string name = !asked.empty() || presetNames.empty()
                                 ? std::string(asked.empty() ? otherwise : asked)
                                 : findPreset(presetNames.back()).pipelines.front();
    const Pipeline pipeline = parsePipeline(name);
    for (const std::string& each : presetNames) {
        const Preset& preset = findPreset(each);
        if (preset.isFor(pipeline)) continue;
        throw UsageError("--preset " + each + ": is not for '" + name + "', but for" +
                         listed(preset.pipelines));
    }
    return pipeline;
}

}  // namespace limpid
