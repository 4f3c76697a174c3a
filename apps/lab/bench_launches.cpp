// `limpid bench launches`: the same samples per pixel in many launches of few samples or few launches of
// many, and the quality of each picture.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/clock.h"
#include "base/files/file.h"
#include "cli/console/json_text.h"
#include "image/metrics/metrics.h"
#include "image/tonemap.h"
#include "lab/bench.h"
#include "lab/svg_plot.h"
#include "renderer/frame/frame_renderer.h"
#include "scene/model/camera.h"

namespace limpid::cli {
namespace {

using nlohmann::json;
struct LaunchesBench {
    DeviceChoice device;
    std::string scene = "builtin:cornell", folder;
    uint32_t width = 640, height = 360, samples = 64, referenceSamples = 1024, repeats = 3;
    bool json = false;
};

struct LaunchesRow {
    uint32_t perLaunch = 1, launches = 1;
    double milliseconds = 0.0;  ///< wall time for all samples; the median of the repeats
    double psnr = 0.0;          ///< against the reference
};

class Still {
  public:
    Still(gpu::Device& device, const LaunchesBench& o)
        : device_(device), o_(o), scene_(scene::openScene({.scene = o.scene})) {
        gpu_ = std::make_unique<scene::GpuScene>(device, scene::buildSceneData(scene_),
                                                 scene::TraceOptions{chosenTracer(o.device, device), {}});
    }

    /// Renders `samples` and returns the picture and the time. Excludes the first launch, in which drivers
    /// compile.
    std::pair<image::Image, double> render(uint32_t perLaunch, uint32_t samples, uint32_t seed) {
        RenderSettings settings;
        settings.extent = {o_.width, o_.height};
        settings.samplesPerLaunch = perLaunch;
        settings.seed = seed;
        const CameraParams camera = scene::cameraParams(scene_.cameras.front(), o_.width, o_.height);
        FrameRenderer warmup(device_, *gpu_, settings, perLaunch);
        warmup.render({.camera = camera});
        device_.waitIdle();
        FrameRenderer still(device_, *gpu_, settings, samples);
        const Clock::time_point start = Clock::now();
        still.render({.camera = camera});
        device_.waitIdle();
        const std::chrono::duration<double, std::milli> elapsed = Clock::now() - start;
        return {beautyOf(still.download()), elapsed.count()};
    }

  private:
    gpu::Device& device_;
    const LaunchesBench& o_;
    scene::Scene scene_;
    std::unique_ptr<scene::GpuScene> gpu_;
};

std::vector<LaunchesRow> measure(gpu::Device& device, const LaunchesBench& o) {
    Still still(device, o);
    const image::Image truth = still.render(4, o.referenceSamples, 1).first;
    const float stops = image::autoExposure(truth);
    RenderSettings wanted;
    std::vector<LaunchesRow> rows;
    for (uint32_t n = 1; n <= o.samples; n *= 2) {
        wanted.samplesPerLaunch = n;
        if (samplesPerLaunch(device, wanted) != n) break;  // CPUs and Sobol' points have limits
        std::vector<double> times;
        image::Image picture;
        for (uint32_t i = 0; i < o.repeats; ++i) {
            double milliseconds = 0.0;
            std::tie(picture, milliseconds) = still.render(n, o.samples, 0);
            times.push_back(milliseconds);
        }
        rows.push_back(
            {n, (o.samples + n - 1) / n, median(times), image::compare(picture, truth, stops).psnr});
    }
    return rows;
}

void print(const LaunchesBench& o, const std::string& device, const std::vector<LaunchesRow>& rows) {
    fmt::print("{}, {}x{}, {}, {} samples per pixel\n{:<20}{:>10}{:>12}{:>12}\n", device, o.width, o.height,
               o.scene, o.samples, "samples a launch", "launches", "ms", "PSNR, dB");
    for (const LaunchesRow& row : rows)
        fmt::print("{:<20}{:>10}{:>12.2f}{:>12.2f}\n", row.perLaunch, row.launches, row.milliseconds,
                   row.psnr);
}

void printJson(const LaunchesBench& o, const std::string& device, const std::vector<LaunchesRow>& rows) {
    json results = json::array();
    for (const LaunchesRow& row : rows)
        results.push_back({{"samples_per_launch", row.perLaunch},
                           {"launches", row.launches},
                           {"ms", row.milliseconds},
                           {"psnr", row.psnr}});
    const json object{{"device", device}, {"width", o.width},     {"height", o.height},
                      {"scene", o.scene}, {"samples", o.samples}, {"results", results}};
    fmt::print("{}\n", jsonText(object));
}

void run(const LaunchesBench& o) {
    if (!o.folder.empty()) makeFolder(o.folder);
    const OpenDevice device = openDevice(o.device);
    const std::vector<LaunchesRow> rows = measure(*device, o);
    if (!o.folder.empty()) {
        PlotLine line{fmt::format("{} samples per pixel", o.samples), {}};
        for (const LaunchesRow& row : rows) line.points.push_back({double(row.perLaunch), row.milliseconds});
        writeTextAtomically(
            std::filesystem::path(o.folder) / "launches.svg",
            linePlot("Samples per launch, " + o.scene, {"samples per launch", "ms", true}, {line}));
    }
    o.json ? printJson(o, device->info().name, rows) : print(o, device->info().name, rows);
}

}  // namespace

void addLaunchesBench(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand(
        "launches", "Measure time and PSNR by samples per launch, for the same total of samples");
    auto o = std::make_shared<LaunchesBench>();
    command->add_option("--scene", o->scene, "Scene to render (builtin:cornell)");
    command->add_option("--width", o->width, "Picture width, pixels (640)")->check(CLI::Range(1, 65535));
    command->add_option("--height", o->height, "Picture height, pixels (360)")->check(CLI::Range(1, 65535));
    command->add_option("--spp", o->samples, "Samples per pixel of each picture (64)")
        ->check(CLI::Range(1, 1 << 20));
    command
        ->add_option("--reference-spp", o->referenceSamples,
                     "Samples per pixel of the reference; more is more accurate (1024)")
        ->check(CLI::Range(1, 1 << 24));
    command->add_option("--repeats", o->repeats, "Number of runs of each setting; the median counts (3)")
        ->check(CLI::Range(1, 1000));
    command->add_option("--out", o->folder, "Folder for the plot launches.svg");
    command->add_flag("--json", o->json, "Print one JSON object on stdout");
    addDeviceOptions(*command, o->device);
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
