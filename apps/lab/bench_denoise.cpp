// `limpid bench denoise`: milliseconds of every pass of an integrator and a denoiser, and how close its
// memory traffic comes to the device's bandwidth.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "bench_copy.comp.h"
#include "cli/console/json_text.h"
#include "cli/options/pipeline_options.h"
#include "lab/bench.h"
#include "lab/bench_scene.h"
#include "renderer/method/network_file.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"

namespace limpid::cli {
namespace {

using nlohmann::json;

struct DenoiseBench {
    DeviceChoice device;
    scene::SceneSource source{.scene = "builtin:cornell"};
    std::string cameraPath = "shake";
    PipelineChoice pipeline;
    std::string preset;
    std::vector<std::string> assignments;
    uint32_t width = 640, height = 360, frames = 100, warmup = 20;
    bool json = false;
    std::string filters = "auto", weights;
};

Pipeline pipelineOf(const DenoiseBench& o) {
    return pipelineFor(o.preset, o.pipeline, parsePipeline("path", "atrous"));
}

/// Returns the bytes per second of a copy between images larger than any cache.
double copyRate(gpu::Device& device) {
    const gpu::Extent extent = device.isCpu() ? gpu::Extent{2048, 1024} : gpu::Extent{8192, 4096};
    const std::vector<float> pixels(size_t{4} * extent.width * extent.height);
    gpu::FrameGraph graph;
    graph.beginFrame();
    gpu::ImageHandle source = graph.transient("source", gpu::Format::RGBA32Float, extent);
    gpu::ImageHandle result = graph.transient("result", gpu::Format::RGBA32Float, extent);
    graph.upload(source, gpu::bytesOf(pixels));
    for (int i = 0; i < 10; ++i) {
        graph.dispatch({.pass = "copy",
                        .shader = shaders::bench_copy_comp,
                        .bindings = {{"source", source}, {"result", result}},
                        .params = {},
                        .constants = {},
                        .extent = extent});
        std::swap(source, result);
    }
    graph.execute(device);
    std::vector<double> times;
    for (const gpu::PassTime& pass : graph.passTimes(device)) times.push_back(pass.milliseconds);
    return 2.0 * static_cast<double>(gpu::bytesOf(pixels).size()) / (median(times) * 1e-3);
}

std::map<std::string, PassCost> measure(gpu::Device& device, const DenoiseBench& o) {
    RenderSettings settings;
    settings.extent = {o.width, o.height};
    settings.pipeline = pipelineOf(o);
    settings.jitter = defaultJitter(settings.pipeline);
    applyPreset(settings, o.preset);
    for (const std::string& text : o.assignments) assign(settings, text);
    settings.networks = loadNetworks(device, settings.pipeline.denoiser, o.weights, settings.denoisers);
    BenchScene scene(device, chosenTracer(o.device, device), o.source, o.cameraPath);
    std::optional<gpu::Backing> filters;
    if (o.filters != "auto") filters = o.filters == "image" ? gpu::Backing::Image : gpu::Backing::Buffer;
    return scene.measure(settings, o.warmup, o.frames, filters);
}

void run(const DenoiseBench& o) {
    const OpenDevice device = openDevice(o.device);
    const double limit = copyRate(*device);
    json passes = json::array();
    if (!o.json) {
        fmt::print("{}, {}x{}, {}, {} frames; a copy moves {:.1f} GB/s\n{:<24}{:>12}{:>12}{:>10}{:>10}\n",
                   device->info().name, o.width, o.height, pipelineOf(o).title(), o.frames, limit * 1e-9,
                   "pass", "ms median", "ms min", "MB", "GB/s");
    }
    for (auto& [name, cost] : measure(*device, o)) {
        const double ms = median(cost.milliseconds);
        const double minimum = *std::ranges::min_element(cost.milliseconds);
        const double rate = static_cast<double>(cost.bytes) / (ms * 1e-3);
        passes.push_back({{"pass", name},
                          {"ms_median", ms},
                          {"ms_minimum", minimum},
                          {"image_bytes", cost.bytes},
                          {"bytes_per_second", rate}});
        if (o.json) continue;
        fmt::print("{:<24}{:>12.4f}{:>12.4f}{:>10.1f}{:>10.1f}\n", name, ms, minimum,
                   static_cast<double>(cost.bytes) * 1e-6, rate * 1e-9);
    }
    if (!o.json) return;
    const json object{{"device", device->info().name},
                      {"driver", device->info().driver},
                      {"scene", o.source.scene},
                      {"camera_path", o.cameraPath},
                      {"integrator", nameOf(pipelineOf(o).integrator)},
                      {"denoiser", nameOf(pipelineOf(o).denoiser)},
                      {"width", o.width},
                      {"height", o.height},
                      {"frames", o.frames},
                      {"copy_bytes_per_second", limit},
                      {"passes", passes}};
    fmt::print("{}\n", jsonText(object));
}

}  // namespace

void addDenoiseBench(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand(
        "denoise", "Time every pass of a frame under a moving camera, and count the bytes it moves");
    auto o = std::make_shared<DenoiseBench>();
    command->add_option("--scene", o->source.scene, "Scene to render (builtin:cornell)");
    command->add_option("--env", o->source.environment, "Environment map: .hdr or .exr, latitude-longitude");
    command->add_option("--camera-path", o->cameraPath,
                        "Camera path: a JSON file, orbit, dolly or shake (shake)");
    addPipelineOptions(*command, o->pipeline, "path, or the preset's", "atrous, or the preset's");
    command->add_option("--preset", o->preset,
                        "Use all settings of a paper, course or tutorial; 'limpid info' lists them");
    command->add_option("--set", o->assignments,
                        "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command->add_option("--weights", o->weights,
                        "Weights file for kpcn instead of the one that comes with Limpid");
    command->add_option("--width", o->width, "Picture width, pixels (640)")->check(CLI::Range(1, 65535));
    command->add_option("--height", o->height, "Picture height, pixels (360)")->check(CLI::Range(1, 65535));
    command->add_option("--frames", o->frames, "Number of frames timed; more is steadier (100)")
        ->check(CLI::Range(1, 100000));
    command->add_option("--warmup", o->warmup, "Number of frames before timing starts (20)")
        ->check(CLI::Range(0, 100000));
    command->add_option("--filters", o->filters, "Storage of filter inputs: auto (default), image or buffer")
        ->check(CLI::IsMember({"auto", "image", "buffer"}));
    command->add_flag("--json", o->json, "Print one JSON object on stdout");
    addDeviceOptions(*command, o->device);
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
