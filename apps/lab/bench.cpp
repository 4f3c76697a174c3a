// `limpid bench`: measures ray-tracing speed and convergence.
#include "lab/bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/error.h"
#include "base/files/file.h"
#include "cli/commands.h"
#include "cli/console/json_text.h"
#include "cli/console/progress.h"
#include "image/io/exr/exr.h"
#include "image/io/png/png.h"
#include "image/metrics/metrics.h"
#include "image/tonemap.h"
#include "lab/svg_plot.h"
#include "renderer/frame/frame_renderer.h"
#include "scene/model/camera.h"

namespace limpid::cli {

std::string sceneStem(const std::string& scene) {
    constexpr std::string_view prefix = "builtin:";
    return scene.starts_with(prefix) ? scene.substr(prefix.size())
                                     : std::filesystem::path(scene).stem().string();
}

namespace {

using nlohmann::json;
struct BenchOptions {
    DeviceChoice device;
    std::vector<std::string> scenes;
    uint32_t width = 640, height = 360, frames = 16, warmup = 4;
    int maxDepth = 4;
    uint64_t referenceSamples = 1024;
    std::string folder = "out";
    bool json = false;
};

struct LoadedScene {
    scene::Scene scene;
    std::unique_ptr<scene::GpuScene> gpu;
    double treeSeconds = 0.0;  ///< building trees and tables
};

LoadedScene load(gpu::Device& device, const DeviceChoice& choice, const std::string& name) {
    LoadedScene loaded;
    loaded.scene = scene::openScene({.scene = name});
    const Clock::time_point start = Clock::now();
    const scene::SceneData data = scene::buildSceneData(loaded.scene);
    loaded.treeSeconds = secondsSince(start);
    loaded.gpu = std::make_unique<scene::GpuScene>(device, data,
                                                   scene::TraceOptions{chosenTracer(choice, device), {}});
    return loaded;
}

RenderSettings settingsOf(const BenchOptions& o) {
    RenderSettings settings;
    settings.extent = {o.width, o.height};
    settings.pathtrace.maxDepth = o.maxDepth;
    return settings;
}

/// Measures one sample per launch: the device time of the path-tracing pass alone.
json traceBench(gpu::Device& device, const BenchOptions& o, const std::string& name) {
    const LoadedScene loaded = load(device, o.device, name);
    FrameRenderer still(device, *loaded.gpu, settingsOf(o), uint64_t{o.frames} + o.warmup);
    still.begin({.camera = scene::cameraParams(loaded.scene.cameras.front(), o.width, o.height)});
    for (uint32_t i = 0; i < o.warmup; ++i) still.launch();
    device.waitIdle();
    const uint64_t raysBefore = still.counters().rays;
    std::vector<double> times;
    for (uint32_t i = 0; i < o.frames; ++i) {
        still.launch();
        for (const gpu::PassTime& pass : still.passTimes()) {
            if (pass.name == "pathtrace") times.push_back(pass.milliseconds);
        }
    }
    const double rays = static_cast<double>(still.counters().rays - raysBefore) / o.frames;
    const double ms = median(times);
    return {{"scene", name},
            {"tracer", scene::toString(loaded.gpu->tracer())},
            {"triangles", loaded.scene.triangleCount()},
            {"tree_seconds", loaded.treeSeconds},
            {"scene_bytes", loaded.gpu->byteCount()},
            {"ms_per_sample", ms},
            {"ms_minimum", *std::min_element(times.begin(), times.end())},
            {"ms_maximum", *std::max_element(times.begin(), times.end())},
            {"rays_per_sample", rays},
            {"million_rays_per_second", rays / (ms * 1e3)}};
}

void runTrace(const BenchOptions& o) {
    const OpenDevice device = openDevice(o.device);
    json results = json::array();
    if (!o.json) {
        fmt::print("{}, tracer {}, {}x{}, depth {}\n{:<24}{:>12}{:>14}{:>14}{:>14}\n", device->info().name,
                   scene::toString(chosenTracer(o.device, *device)), o.width, o.height, o.maxDepth, "scene",
                   "triangles", "ms a sample", "Mrays/s", "tree s");
    }
    for (const std::string& name : o.scenes) {
        const json r = traceBench(*device, o, name);
        results.push_back(r);
        if (!o.json) {
            fmt::print("{:<24}{:>12}{:>14.3f}{:>14.2f}{:>14.3f}\n", name, r["triangles"].get<uint64_t>(),
                       r["ms_per_sample"].get<double>(), r["million_rays_per_second"].get<double>(),
                       r["tree_seconds"].get<double>());
        }
    }
    if (!o.json) return;
    const json object{{"device", device->info().name},
                      {"driver", device->info().driver},
                      {"width", o.width},
                      {"height", o.height},
                      {"max_depth", o.maxDepth},
                      {"frames", o.frames},
                      {"results", results}};
    fmt::print("{}\n", jsonText(object));
}

struct Picture {
    uint64_t samples = 0;
    double seconds = 0.0;
    uint64_t rays = 0;
    RenderedLayers layers;
};

Picture renderPicture(gpu::Device& device, scene::GpuScene& scene, const CameraParams& camera,
                      RenderSettings settings, uint64_t samples) {
    Picture picture;
    settings.samplesPerLaunch = static_cast<uint32_t>(std::min<uint64_t>(samples, 4));
    FrameRenderer still(device, scene, settings, samples);
    still.begin({.camera = camera});
    const Clock::time_point start = Clock::now();
    Progress progress("samples", samples);
    while (still.launch()) progress.show(still.samplesInMean());
    device.waitIdle();
    picture.seconds = secondsSince(start);
    picture.samples = still.samplesInMean();
    picture.rays = still.counters().rays;
    picture.layers = still.download();
    return picture;
}

void writePicture(const BenchOptions& o, const std::string& stem, const Picture& picture, float stops) {
    const std::filesystem::path base =
        std::filesystem::path(o.folder) / fmt::format("{}.{}spp", stem, picture.samples);
    image::writeExr(base.string() + ".exr", toLayeredImage(picture.layers, {}, image::Storage::Half));
    image::writePng(base.string() + ".png", image::toBytes(image::tonemap(beautyOf(picture.layers), stops)));
}

json convergence(gpu::Device& device, const BenchOptions& o, const std::string& name) {
    const LoadedScene loaded = load(device, o.device, name);
    const CameraParams camera = scene::cameraParams(loaded.scene.cameras.front(), o.width, o.height);
    RenderSettings settings = settingsOf(o);
    settings.pathtrace.maxDepth = 8;
    {
        // Compile the pipelines first, so that this does not count as rendering time.
        FrameRenderer warmup(device, *loaded.gpu, settings, 1);
        warmup.render({.camera = camera});
    }
    settings.seed = 1;  // a noise seed different from the reference's
    const Picture converged = renderPicture(device, *loaded.gpu, camera, settings, o.referenceSamples);
    const image::Image truth = beautyOf(converged.layers);
    const float stops = image::autoExposure(truth);
    writePicture(o, sceneStem(name), converged, stops);
    json rows = json::array();
    const auto add = [&](const Picture& p, const json& psnr) {
        rows.push_back({{"scene", name},
                        {"samples", p.samples},
                        {"seconds", p.seconds},
                        {"million_rays_per_second", static_cast<double>(p.rays) * 1e-6 / p.seconds},
                        {"psnr", psnr}});
    };
    settings.seed = 0;
    // With more than a quarter of the reference's samples, the reference's own noise would dominate.
    const uint64_t maxSamples = std::max<uint64_t>(o.referenceSamples / 4, 1);
    for (uint64_t samples = 1; samples <= maxSamples; samples *= 4) {
        const Picture noisy = renderPicture(device, *loaded.gpu, camera, settings, samples);
        add(noisy, image::compare(beautyOf(noisy.layers), truth, stops).psnr);
        writePicture(o, sceneStem(name), noisy, stops);
    }
    add(converged, nullptr);
    return rows;
}

/// Plots PSNR over samples, one line per scene.
void plotConvergence(const BenchOptions& o, const json& rows) {
    std::vector<PlotLine> lines;
    for (const json& row : rows) {
        if (row["psnr"].is_null()) continue;
        const std::string scene = row["scene"];
        if (lines.empty() || lines.back().name != scene) lines.push_back({scene, {}});
        lines.back().points.push_back({row["samples"], row["psnr"]});
    }
    if (lines.empty()) return;
    writeTextAtomically(std::filesystem::path(o.folder) / "convergence.svg",
                        linePlot("Convergence", {"samples per pixel", "PSNR, dB", true}, lines));
}

void runConvergence(const BenchOptions& o) {
    makeFolder(o.folder);
    const OpenDevice device = openDevice(o.device);
    json all = json::array();
    if (!o.json) {
        fmt::print("{}, {}x{}\n{:<26}{:>9}{:>10}{:>10}{:>10}\n", device->info().name, o.width, o.height,
                   "scene", "samples", "seconds", "Mrays/s", "PSNR dB");
    }
    for (const std::string& name : o.scenes) {
        for (const json& row : convergence(*device, o, name)) {
            all.push_back(row);
            if (o.json) continue;
            const std::string psnr =
                row["psnr"].is_null() ? "reference" : fmt::format("{:.2f}", row["psnr"].get<double>());
            fmt::print("{:<26}{:>9}{:>10.2f}{:>10.2f}{:>10}\n", name, row["samples"].get<uint64_t>(),
                       row["seconds"].get<double>(), row["million_rays_per_second"].get<double>(), psnr);
        }
    }
    plotConvergence(o, all);
    if (o.json) fmt::print("{}\n", jsonText({{"device", device->info().name}, {"results", all}}));
}

void addCommon(CLI::App& command, const std::shared_ptr<BenchOptions>& o) {
    command.add_option("--scene", o->scenes, "Scene to measure (repeatable; default: built-in scenes)");
    command.add_option("--width", o->width, "Picture width, pixels (640)")->check(CLI::Range(1, 65535));
    command.add_option("--height", o->height, "Picture height, pixels (360)")->check(CLI::Range(1, 65535));
    command.add_flag("--json", o->json, "Print one JSON object on stdout");
    addDeviceOptions(command, o->device);
}

}  // namespace

void addBenchCommand(CLI::App& app) {
    CLI::App* bench = app.add_subcommand("bench", "Measure speed and convergence");
    bench->require_subcommand(1);
    auto options = std::make_shared<BenchOptions>();
    CLI::App* trace = bench->add_subcommand("trace", "Measure milliseconds per sample and rays per second");
    addCommon(*trace, options);
    trace->add_option("--frames", options->frames, "Number of launches timed; more is steadier (16)")
        ->check(CLI::Range(1, 100000));
    trace->add_option("--warmup", options->warmup, "Number of launches before timing starts (4)")
        ->check(CLI::Range(1, 100000));
    trace->add_option("--max-depth", options->maxDepth, "Maximum number of bounces; more is slower (4)")
        ->check(CLI::Range(0, 1024));
    trace->callback([options] {
        if (options->scenes.empty()) options->scenes = {"builtin:cornell", "builtin:heavy"};
        runTrace(*options);
    });
    CLI::App* converge = bench->add_subcommand(
        "convergence", "Measure PSNR by number of samples; writes pictures (PNG, EXR) and a plot");
    addCommon(*converge, options);
    converge
        ->add_option(
            "--spp", options->referenceSamples,
            "Samples per pixel of the converged picture; noisy ones have up to a quarter of it (1024)")
        ->check(CLI::Range(2, 1 << 24));
    converge->add_option("--out", options->folder, "Folder for the pictures (out)");
    converge->callback([options] {
        if (options->scenes.empty()) options->scenes = {"builtin:cornell", "builtin:cornell-spheres"};
        runConvergence(*options);
    });
    addDenoiseBench(*bench);
    addFilesBench(*bench);
    addFirstFrameBench(*bench);
    addKpcnBench(*bench);
    addLaunchesBench(*bench);
    addQualityBench(*bench);
    addServeBench(*bench);
    addSvgfBench(*bench);
}

}  // namespace limpid::cli
