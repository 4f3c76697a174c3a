// `limpid bench first-frame`: the time of an embedded denoiser's first frame compared with later ones, after
// its pipelines were prepared, and how long preparing them takes with and without an earlier run's pipeline
// cache.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <numeric>

#include "base/error.h"
#include "denoise/api/denoiser.h"
#include "lab/bench.h"
#include "renderer/frame/pipeline_store.h"

namespace limpid::cli {
namespace {

struct FirstFrameBench {
    DeviceChoice device;
    std::string denoiser = "svgf";
    uint32_t width = 1280, height = 720, frames = 20;
};

/// A frame of noise in front of a wall; its content does not matter.
denoise::HostFrame noisyWall(uint32_t width, uint32_t height) {
    denoise::HostFrame frame;
    frame.width = width;
    frame.height = height;
    const size_t pixels = frame.pixelCount();
    frame.forEach([&](const LayerInfo& layer, auto& values) {
        using Value = typename std::remove_reference_t<decltype(values)>::value_type;
        values.assign((layer.stored == Stored::Uint ? 2 : 4) * pixels, Value(0));
    });
    for (size_t p = 0; p < pixels; ++p) {
        frame.diffuse[4 * p] = static_cast<float>(p * 2654435761u % 1000) * 1e-3f;
        frame.albedo[4 * p] = frame.albedo[4 * p + 1] = frame.albedo[4 * p + 2] = 0.5f;
        frame.normal[4 * p + 2] = frame.previousNormal[4 * p + 2] = 1.0f;
        frame.depth[4 * p] = 2.0f;
        frame.depth[4 * p + 1] = frame.motion[4 * p + 3] = 1.0f;
    }
    frame.camera.forward = {0, 0, -1};
    frame.camera.right = {1, 0, 0};
    frame.camera.up = {0, 0.5625f, 0};
    frame.camera.spread = 2.0f / static_cast<float>(width);
    return frame;
}

bool canBeMeasured(const denoise::Denoiser& denoiser) {
    return !denoiser.network && !denoiser.oneChannel;
}

std::string measurable() {
    std::vector<std::string_view> names;
    for (const denoise::Denoiser& denoiser : denoise::denoisers())
        if (canBeMeasured(denoiser)) names.push_back(denoiser.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

double millisecondsOf(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void run(const FirstFrameBench& o) {
    const denoise::Denoiser* method = denoise::findDenoiser(o.denoiser);
    if (!method || !canBeMeasured(*method)) throw UsageError("--denoiser: one of " + measurable());
    const denoise::HostFrame host = noisyWall(o.width, o.height);
    gpu::Device device(o.device.device);
    loadPipelines(device, pipelineFile(device));
    const gpu::FilterChoice choice = gpu::filterChoice(device);
    gpu::FrameGraph graph;
    const auto record = [&] {
        graph.beginFrame();
        denoise::DenoiserInput input = denoise::upload(graph, host);
        input.choose(choice);
        method->record(graph, input, {}, {});
    };
    record();
    const double prepare = millisecondsOf([&] { graph.prepare(device); });
    std::vector<double> frames;
    for (uint32_t i = 0; i <= o.frames; ++i) {
        if (i > 0) record();
        const double wall = millisecondsOf([&] {
            graph.execute(device);
            device.waitIdle();
        });
        double passes = 0;
        for (const gpu::PassTime& time : graph.passTimes(device)) passes += time.milliseconds;
        frames.push_back(passes);
        if (i == 0)
            fmt::print("first frame: passes {:.3f} ms, from submission to the end {:.3f} ms\n", passes, wall);
    }
    const double later = median({frames.begin() + 1, frames.end()});
    fmt::print("later frames: passes {:.3f} ms (median of {})\nratio: {:.2f}\n", later, o.frames,
               frames[0] / later);
    fmt::print("{} pipelines, prepared in {:.1f} ms\n", device.pipelineCount(), prepare);
    storePipelines(device, pipelineFile(device));
}

}  // namespace

void addFirstFrameBench(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand(
        "first-frame",
        "The first frame of a denoiser beside later ones, and how long preparing pipelines takes");
    auto o = std::make_shared<FirstFrameBench>();
    command->add_option("--denoiser", o->denoiser, "Denoiser: " + measurable() + " (svgf)");
    command->add_option("--width", o->width, "Pixels (1280)")->check(CLI::Range(1, 16384));
    command->add_option("--height", o->height, "Pixels (720)")->check(CLI::Range(1, 16384));
    command->add_option("--frames", o->frames, "Later frames (20)")->check(CLI::Range(1, 10000));
    addDeviceOptions(*command, o->device);
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
