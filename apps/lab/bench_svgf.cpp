// `limpid bench svgf`: the cost of SVGF's stages, and how it depends on the scene's triangles and the
// filter's levels.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/files/file.h"
#include "cli/console/json_text.h"
#include "lab/bench.h"
#include "lab/bench_scene.h"
#include "lab/svg_plot.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"
#include "scene/builtin/builtin.h"

namespace limpid::cli {
namespace {

using nlohmann::json;

constexpr int maxLevels = 8;

struct SvgfBench {
    DeviceChoice device;
    std::string scene = "builtin:cornell-spheres", folder, preset;
    std::vector<std::string> assignments;
    uint32_t width = 640, height = 360, frames = 30, warmup = 10;
    bool json = false;
};

/// Milliseconds by stage, in the frame's order.
struct Stages {
    std::vector<Bar> bars;

    double tracing() const { return bars.front().value; }
    double filtering() const {
        double sum = 0.0;
        for (const Bar& bar : bars) sum += bar.value;
        return sum - tracing();
    }
};

/// A pass belongs to the stage whose name it begins with. Not every stage has passes on every device.
constexpr std::array<std::pair<const char*, const char*>, 12> stageNames{{{"path tracing", "pathtrace"},
                                                                          {"surfaces", "surfaces"},
                                                                          {"reprojection", "svgf/reproject"},
                                                                          {"tiles", "svgf/tiles"},
                                                                          {"lags", "svgf/lags"},
                                                                          {"anti-lag", "svgf/antilag"},
                                                                          {"variance", "svgf/variance"},
                                                                          {"a-trous levels", "svgf/level"},
                                                                          {"young pixels", "svgf/young"},
                                                                          {"composition", "svgf/compose"},
                                                                          {"edges", "edges"},
                                                                          {"anti-aliasing", "taa"}}};

Stages stagesOf(const std::map<std::string, PassCost>& costs) {
    Stages stages;
    for (const auto& [name, prefix] : stageNames) {
        double sum = 0.0;
        for (const auto& [pass, cost] : costs)
            sum += pass.starts_with(prefix) ? median(cost.milliseconds) : 0.0;
        if (sum > 0.0 || stages.bars.empty()) stages.bars.push_back({name, sum});
    }
    return stages;
}

RenderSettings settingsOf(const SvgfBench& o) {
    RenderSettings settings;
    settings.extent = {o.width, o.height};
    settings.pipeline = pipelineFor(o.preset, {"path", "svgf"}, {});
    settings.jitter = defaultJitter(settings.pipeline);
    applyPreset(settings, o.preset);
    for (const std::string& text : o.assignments) assign(settings, text);
    return settings;
}

struct OfScene {
    std::string scene;
    uint64_t triangles = 0;
    Stages stages;
};

/// Measures the built-in scenes, sorted by triangles.
std::vector<OfScene> measureScenes(gpu::Device& device, const SvgfBench& o) {
    std::vector<OfScene> result;
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) {
        const std::string name = "builtin:" + info.name;
        BenchScene scene(device, chosenTracer(o.device, device), {.scene = name});
        result.push_back(
            {name, scene.triangleCount(), stagesOf(scene.measure(settingsOf(o), o.warmup, o.frames))});
    }
    std::ranges::stable_sort(result, {}, &OfScene::triangles);
    return result;
}

/// Measures 1 to 8 levels.
std::vector<Stages> measureLevels(BenchScene& scene, const SvgfBench& o) {
    std::vector<Stages> result;
    RenderSettings settings = settingsOf(o);
    for (int levels = 1; levels <= maxLevels; ++levels) {
        settings.denoisers.svgf.levels = levels;
        result.push_back(stagesOf(scene.measure(settings, o.warmup, o.frames)));
    }
    return result;
}

struct Measured {
    Stages stages;
    std::vector<OfScene> scenes;
    std::vector<Stages> levels;
};

void writePlots(const SvgfBench& o, const Measured& m) {
    const std::filesystem::path folder(o.folder);
    writeTextAtomically(folder / "svgf-stages.svg",
                        barPlot("Time per stage, " + o.scene, "ms", m.stages.bars));
    PlotLine tracing{"path tracing", {}}, filtering{"SVGF", {}}, levels{"SVGF", {}};
    for (const OfScene& scene : m.scenes) {
        const auto triangles = static_cast<double>(scene.triangles);
        tracing.points.push_back({triangles, scene.stages.tracing()});
        filtering.points.push_back({triangles, scene.stages.filtering()});
    }
    for (size_t i = 0; i < m.levels.size(); ++i)
        levels.points.push_back({static_cast<double>(i + 1), m.levels[i].filtering()});
    writeTextAtomically(folder / "svgf-triangles.svg",
                        linePlot("Time against triangles", {"triangles", "ms", true}, {tracing, filtering}));
    writeTextAtomically(folder / "svgf-levels.svg",
                        linePlot("Time against levels", {"levels", "ms"}, {levels}));
}

void print(const SvgfBench& o, const std::string& device, const Measured& m) {
    fmt::print("{}, {}x{}, {}, {} frames\n{:<20}{:>10}\n", device, o.width, o.height, o.scene, o.frames,
               "stage", "ms");
    for (const Bar& bar : m.stages.bars) fmt::print("{:<20}{:>10.4f}\n", bar.name, bar.value);
    fmt::print("\n{:<28}{:>11}{:>14}{:>10}\n", "scene", "triangles", "tracing, ms", "SVGF, ms");
    for (const OfScene& scene : m.scenes)
        fmt::print("{:<28}{:>11}{:>14.4f}{:>10.4f}\n", scene.scene, scene.triangles, scene.stages.tracing(),
                   scene.stages.filtering());
    fmt::print("\n{:<8}{:>10}\n", "levels", "SVGF, ms");
    for (size_t i = 0; i < m.levels.size(); ++i)
        fmt::print("{:<8}{:>10.4f}\n", i + 1, m.levels[i].filtering());
}

json stagesJson(const Stages& stages) {
    json object = json::object();
    for (const Bar& bar : stages.bars) object[bar.name] = bar.value;
    return object;
}

void printJson(const SvgfBench& o, const std::string& device, const Measured& m) {
    json scenes = json::array(), levels = json::array();
    for (const OfScene& scene : m.scenes)
        scenes.push_back(
            {{"scene", scene.scene}, {"triangles", scene.triangles}, {"ms", stagesJson(scene.stages)}});
    for (size_t i = 0; i < m.levels.size(); ++i)
        levels.push_back({{"levels", i + 1}, {"ms", stagesJson(m.levels[i])}});
    const json object{{"device", device},   {"width", o.width}, {"height", o.height},
                      {"frames", o.frames}, {"scene", o.scene}, {"ms", stagesJson(m.stages)},
                      {"scenes", scenes},   {"levels", levels}};
    fmt::print("{}\n", jsonText(object));
}

void run(const SvgfBench& o) {
    settingsOf(o);
    if (!o.folder.empty()) makeFolder(o.folder);
    const OpenDevice device = openDevice(o.device);
    Measured measured;
    {
        BenchScene scene(*device, chosenTracer(o.device, *device), {.scene = o.scene});
        measured.stages = stagesOf(scene.measure(settingsOf(o), o.warmup, o.frames));
        measured.levels = measureLevels(scene, o);
    }
    measured.scenes = measureScenes(*device, o);
    if (!o.folder.empty()) writePlots(o, measured);
    if (o.json)
        printJson(o, device->info().name, measured);
    else
        print(o, device->info().name, measured);
}

}  // namespace

void addSvgfBench(CLI::App& bench) {
    CLI::App* command =
        bench.add_subcommand("svgf", "Time SVGF: per stage, by number of triangles, and by number of levels");
    auto o = std::make_shared<SvgfBench>();
    command->add_option("--scene", o->scene,
                        "Scene for the measurement of stages and levels (builtin:cornell-spheres)");
    command->add_option("--preset", o->preset,
                        "Preset of SVGF from a paper or course; 'limpid info' lists them");
    command->add_option("--set", o->assignments,
                        "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command->add_option("--width", o->width, "Picture width, pixels (640)")->check(CLI::Range(1, 65535));
    command->add_option("--height", o->height, "Picture height, pixels (360)")->check(CLI::Range(1, 65535));
    command->add_option("--frames", o->frames, "Number of frames timed; more is steadier (30)")
        ->check(CLI::Range(1, 100000));
    command->add_option("--warmup", o->warmup, "Number of frames before timing starts (10)")
        ->check(CLI::Range(0, 100000));
    command->add_option("--out", o->folder, "Folder for three plots (SVG)");
    command->add_flag("--json", o->json, "Print one JSON object on stdout");
    addDeviceOptions(*command, o->device);
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
