// limpid bench quality: how near denoised sequences come to converged ones, in numbers and pictures.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "bench.h"
#include "bench_quality.h"
#include "image/png.h"
#include "image/tonemap.h"
#include "renderer/parameters.h"
#include "scene/camera_path.h"
#include "scene/movement.h"

namespace limpid::cli {
namespace {

using nlohmann::json;

struct QualityOptions {
    DeviceChoice device;
    std::vector<std::string> scenes, pipelines, presets, assignments, variants;
    std::string environment, cameraPath = "orbit", folder;
    uint32_t width = 640, height = 360, samples = 1;
    uint64_t referenceSamples = 4096;
    QualityFrames frames;
    bool json = false;
};

/// Every pipeline as it is, and the last in every variant.
std::vector<QualityMethod> methodsOf(const QualityOptions& o) {
    RenderSettings common;
    common.extent = {o.width, o.height};
    common.jitter = Jitter::Off;
    common.layers = true;  // the noisy frames are judged too
    for (const std::string& preset : o.presets) applyPreset(common, preset);
    for (const std::string& text : o.assignments) assign(common, text);
    std::vector<QualityMethod> methods;
    for (const std::string& pipeline : o.pipelines) {
        common.pipeline = parsePipeline(pipeline);
        methods.push_back({pipeline, common});
    }
    for (const std::string& variant : o.variants) {
        QualityMethod method{variant, common};
        std::istringstream words(variant);
        for (std::string text; std::getline(words, text, ',');) assign(method.settings, text);
        methods.push_back(std::move(method));
    }
    return methods;
}

SequenceQuality measureScene(gpu::Device& device, const QualityOptions& o, const std::string& name) {
    scene::Scene scene = loadChosenScene({name, o.environment, ""});
    if (!scene.rig.clips.empty()) scene::chooseClip(scene, "");
    const scene::SceneData data = scene::buildSceneData(scene);
    scene::GpuScene gpuScene(device, data, {chosenTracer(o.device, device), {}});
    const SequenceTiming timing;
    std::optional<scene::CameraPath> path;
    if (o.cameraPath != "none") {
        path = scene::isBuiltinCameraPath(o.cameraPath)
                   ? scene::builtinCameraPath(o.cameraPath, scene, scene.cameras.front(),
                                              timing.timeOf(o.frames.count))
                   : scene::loadCameraPath(o.cameraPath);
    }
    const Sequence sequence(scene, data, scene.cameras.front(), path, timing);
    return measureQuality(device, gpuScene, sequence, methodsOf(o), o.frames, o.referenceSamples, o.samples);
}

/// Infinite where a frame equals its reference: JSON has no such number.
json numberOrNull(std::optional<double> value) {
    return value && std::isfinite(*value) ? json(*value) : json(nullptr);
}

json scoresJson(const MethodQuality& method) {
    json object{{"method", method.name}, {"median_ms", method.medianMs}};
    for (const image::Metric& metric : image::sequenceMetrics()) {
        if (metric.name == "hdr_flip") continue;
        const std::optional<image::Worst> worst = image::worstOf(metric, method.scores);
        object[std::string(metric.name)] = {
            {"mean", numberOrNull(image::meanOf(metric, method.scores))},
            {"worst", numberOrNull(worst ? std::optional(worst->value) : std::nullopt)},
            {"worst_frame", worst ? worst->frame : -1}};
    }
    return object;
}

void printScene(const std::string& scene, const SequenceQuality& quality) {
    fmt::print("{} (reference: {:.1f} dB by itself)\n", scene, quality.referencePsnr);
    double noisyPsnr = 0.0;
    for (const MethodQuality& method : quality.methods) {
        std::vector<double> means;
        for (const image::Metric& metric : image::sequenceMetrics())
            means.push_back(image::meanOf(metric, method.scores).value_or(0.0));
        if (&method == &quality.methods.front()) noisyPsnr = means[0];
        double filterMs = 0.0;
        for (const auto& [pass, ms] : method.medianMs) filterMs += pass == "pathtrace" ? 0.0 : ms;
        fmt::print("  {:<10}{:>9.2f}{:>+8.2f}{:>9.2f}{:>9.4f}{:>10.5f}{:>9.4f}{:>10.5f}{:>10.3f}\n",
                   method.name, means[0], means[0] - noisyPsnr,
                   image::worstOf(image::sequenceMetrics()[0], method.scores)->value, means[1], means[2],
                   means[3], means[5], filterMs);
    }
}

/// Noisy, every method, reference, side by side.
void writeSideBySide(const std::filesystem::path& file, const SequenceQuality& quality) {
    std::vector<const image::Image*> pictures;
    for (const MethodQuality& method : quality.methods) pictures.push_back(&method.last);
    pictures.push_back(&quality.reference);
    const uint32_t width = quality.reference.width, height = quality.reference.height;
    image::Image all(width * static_cast<uint32_t>(pictures.size()), height, 3);
    for (size_t i = 0; i < pictures.size(); ++i) {
        for (uint32_t y = 0; y < height; ++y) {
            std::copy_n(&pictures[i]->pixels[size_t{3} * y * width], 3 * width,
                        &all.pixels[size_t{3} * (size_t{y} * all.width + i * width)]);
        }
    }
    image::writePng(file, image::toBytes(image::tonemap(all, quality.exposure)));
}

void run(const QualityOptions& o) {
    if (o.frames.first >= o.frames.count) throw UsageError("--first: there are fewer frames");
    methodsOf(o);
    const std::unique_ptr<gpu::Device> device = openDevice(o.device);
    if (!o.folder.empty()) std::filesystem::create_directories(o.folder);
    if (!o.json) {
        fmt::print(
            "{}, {}x{}, {} samples a frame, frames {} to {}, references of {}\n  {:<10}{:>9}{:>8}{:>9}{:>9}"
            "{:>10}{:>9}{:>10}{:>10}\n",
            device->info().name, o.width, o.height, o.samples, o.frames.first, o.frames.count - 1,
            o.referenceSamples, "method", "PSNR dB", "gain", "worst", "SSIM", "relMSE", "FLIP", "flicker",
            "filter ms");
    }
    json scenes = json::array();
    for (const std::string& name : o.scenes) {
        const SequenceQuality quality = measureScene(*device, o, name);
        if (!o.json) printScene(name, quality);
        if (!o.folder.empty())
            writeSideBySide(std::filesystem::path(o.folder) / ("quality." + sceneStem(name) + ".png"),
                            quality);
        json methods = json::array();
        for (const MethodQuality& method : quality.methods) methods.push_back(scoresJson(method));
        scenes.push_back({{"scene", name},
                          {"exposure", quality.exposure},
                          {"reference_psnr", numberOrNull(quality.referencePsnr)},
                          {"methods", methods}});
    }
    if (!o.json) return;
    const json object{{"device", device->info().name},
                      {"width", o.width},
                      {"height", o.height},
                      {"samples", o.samples},
                      {"reference_samples", o.referenceSamples},
                      {"first_frame", o.frames.first},
                      {"frames", o.frames.count},
                      {"scenes", scenes}};
    fmt::print("{}\n", object.dump(2));
}

}  // namespace

void addQualityBench(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand(
        "quality", "Denoised sequences against converged ones: PSNR, SSIM, FLIP, flicker");
    auto o = std::make_shared<QualityOptions>();
    command->add_option("--scene", o->scenes, "Scenes (repeatable; builtin:cornell)");
    command->add_option("--env", o->environment, "Environment map of all of them");
    command->add_option("--pipeline", o->pipelines, "Pipelines that denoise (repeatable; all of them)");
    command->add_option("--camera-path", o->cameraPath, "orbit (default), dolly, shake, a file, or none");
    command->add_option("--frames", o->frames.count, "Frames (61)")->check(CLI::Range(1, 100000));
    command->add_option("--first", o->frames.first, "First frame that is compared (16)")
        ->check(CLI::Range(0, 100000));
    command->add_option("--spp", o->samples, "Samples per pixel and frame (1)")->check(CLI::Range(1, 65536));
    command->add_option("--reference-spp", o->referenceSamples, "Samples of the references (4096)")
        ->check(CLI::Range(2, 1 << 24));
    command->add_option("--width", o->width, "Pixels (640)")->check(CLI::Range(1, 65535));
    command->add_option("--height", o->height, "Pixels (360)")->check(CLI::Range(1, 65535));
    command->add_option("--preset", o->presets, "A named set of parameters");
    command->add_option("--set", o->assignments, "A parameter: group.name=value");
    command->add_option("--variant", o->variants,
                        "The last pipeline once more with these parameters, by commas (repeatable)");
    command->add_option("--out", o->folder, "Folder for a picture of each scene, everything side by side");
    command->add_flag("--json", o->json, "One JSON object on stdout");
    addDeviceOptions(*command, o->device);
    command->callback([o] {
        if (o->scenes.empty()) o->scenes = {"builtin:cornell"};
        if (o->pipelines.empty()) {
            for (const denoise::Denoiser& denoiser : denoise::denoisers())
                o->pipelines.emplace_back(denoiser.name);
        }
        run(*o);
    });
}

}  // namespace limpid::cli
