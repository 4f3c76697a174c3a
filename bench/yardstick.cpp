// limpid_yardstick: compares our path tracer with a native one on Embree, on the same paths, in one process.
// The two run alternately, so that other load on the machine affects both.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "embree_tracer.h"
#include "image/metrics/metrics.h"
#include "renderer/frame/frame_renderer.h"
#include "scene/builtin/builtin.h"
#include "scene/model/camera.h"
#include "scene/prepare/prepare.h"

namespace limpid::bench {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

/// Largest accepted relative difference of ray counts. Paths are equal except for rounding, but a ray that
/// hits an edge may hit either side.
constexpr double maxRayDifference = 0.005;

struct Options {
    std::vector<std::string> scenes{"cornell", "heavy"};
    std::string device = "cpu";
    uint32_t width = 640, height = 360, rounds = 6, frames = 4, warmup = 2;
    uint32_t maxDepth = 4;
    bool json = false;
};

/// The times of all frames in milliseconds.
struct Times {
    std::vector<double> values;

    double median() const {
        std::vector<double> sorted = values;
        std::sort(sorted.begin(), sorted.end());
        return sorted[sorted.size() / 2];
    }
    double best() const { return *std::min_element(values.begin(), values.end()); }
};

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

class EmbreeSide {
  public:
    EmbreeSide(const scene::Scene& scene, const scene::SceneData& data, const Options& o)
        : scene_(scene, data) {
        launch_ = {.camera = scene::cameraParams(scene.cameras.front(), o.width, o.height),
                   .width = o.width,
                   .height = o.height,
                   .maxDepth = o.maxDepth,
                   .rouletteDepth = static_cast<uint32_t>(PathtraceSettings{}.rouletteDepth)};
        sum_.resize(size_t{o.width} * o.height);
    }

    /// Returns the time of the whole frame.
    double frame() {
        const Clock::time_point start = Clock::now();
        rays_ += traceSample(scene_, launch_, sum_);
        ++launch_.frame;
        return millisecondsSince(start);
    }

    uint64_t rays() const { return rays_; }

    image::Image mean() const {
        image::Image picture(launch_.width, launch_.height, 3);
        for (size_t i = 0; i < sum_.size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                picture.pixels[3 * i + static_cast<size_t>(c)] = sum_[i][c] / std::max(sum_[i].w, 1.0f);
            }
        }
        return picture;
    }

  private:
    EmbreeScene scene_;
    EmbreeLaunch launch_;
    std::vector<vec4> sum_;
    uint64_t rays_ = 0;
};

class OurSide {
  public:
    OurSide(gpu::Device& device, const scene::Scene& scene, const scene::SceneData& data, const Options& o)
        : device_(device), gpuScene_(device, data), still_(device, gpuScene_, settingsOf(o), UINT64_MAX) {
        still_.begin({.camera = scene::cameraParams(scene.cameras.front(), o.width, o.height)});
    }

    /// Returns the device time of the path-tracing pass, as `limpid bench trace` reports it.
    double frame() {
        still_.launch();
        device_.waitIdle();
        for (const gpu::PassTime& pass : still_.passTimes()) {
            if (pass.name == "pathtrace") return pass.milliseconds;
        }
        throw Error("the frame has no pass 'pathtrace'");
    }

    uint64_t rays() { return still_.counters().rays; }
    image::Image mean() { return beautyOf(still_.download()); }

  private:
    static RenderSettings settingsOf(const Options& o) {
        RenderSettings settings;
        settings.extent = {o.width, o.height};
        settings.pathtrace.maxDepth = static_cast<int>(o.maxDepth);
        settings.pathtrace.lightTree = false;     // the Embree tracer chooses lights by power
        settings.pathtrace.samplerSobol = false;  // and draws independent numbers
        return settings;
    }

    gpu::Device& device_;
    scene::GpuScene gpuScene_;
    FrameRenderer still_;
};

void checkRays(const std::string& scene, double embree, double ours) {
    if (std::abs(ours / embree - 1.0) <= maxRayDifference) return;
    throw Error(fmt::format("{}: the paths are not equal: {} rays of ours against {} of Embree's", scene,
                            ours, embree));
}

json measure(gpu::Device& device, const Options& o, const std::string& name) {
    scene::Scene scene = scene::builtinScene(name);
    scene::prepare(scene);
    const scene::SceneData data = scene::buildSceneData(scene);
    EmbreeSide embree(scene, data, o);
    OurSide ours(device, scene, data, o);
    for (uint32_t i = 0; i < o.warmup; ++i) {
        embree.frame();
        ours.frame();
    }
    Times embreeTimes, ourTimes;
    for (uint32_t round = 0; round < o.rounds; ++round) {
        for (uint32_t i = 0; i < o.frames; ++i) embreeTimes.values.push_back(embree.frame());
        for (uint32_t i = 0; i < o.frames; ++i) ourTimes.values.push_back(ours.frame());
    }
    const auto samples = static_cast<double>(o.warmup + uint64_t{o.rounds} * o.frames);
    const double embreeRays = static_cast<double>(embree.rays()) / samples;
    const double ourRays = static_cast<double>(ours.rays()) / samples;
    checkRays(name, embreeRays, ourRays);
    const image::Image ourMean = ours.mean(), embreeMean = embree.mean();
    const image::Comparison comparison = image::compare(ourMean, embreeMean, 0.0f);
    return {{"scene", name},
            {"triangles", scene.triangleCount()},
            {"embree_ms", embreeTimes.median()},
            {"embree_ms_best", embreeTimes.best()},
            {"ours_ms", ourTimes.median()},
            {"ours_ms_best", ourTimes.best()},
            {"ratio", embreeTimes.median() / ourTimes.median()},
            {"ratio_best", embreeTimes.best() / ourTimes.best()},
            {"embree_rays_per_sample", embreeRays},
            {"ours_rays_per_sample", ourRays},
            {"embree_mean", image::mean(embreeMean)},
            {"ours_mean", image::mean(ourMean)},
            {"psnr", comparison.psnr}};
}

void printRow(const json& r) {
    const auto number = [&](const char* key) { return r[key].get<double>(); };
    fmt::print(
        "{:<10}{:>9.1f}{:>9.1f}{:>10.1f}{:>9.1f}{:>9.3f}{:>9.3f}{:>12.0f}{:>12.0f}{:>11.5f}{:>11.5f}{:>8.1f}"
        "\n",
        r["scene"].get<std::string>(), number("embree_ms"), number("embree_ms_best"), number("ours_ms"),
        number("ours_ms_best"), number("ratio"), number("ratio_best"), number("embree_rays_per_sample"),
        number("ours_rays_per_sample"), number("embree_mean"), number("ours_mean"), number("psnr"));
}

void run(const Options& o) {
    gpu::Device device(gpu::DeviceOptions{.select = o.device, .messages = log::write});
    const std::string embree = embreeVersion();
    if (!o.json) {
        fmt::print("Embree {}; ours on {}; {}x{}, depth {}, {} rounds of {} frames\n", embree,
                   device.info().name, o.width, o.height, o.maxDepth, o.rounds, o.frames);
        fmt::print("{:<10}{:>9}{:>9}{:>10}{:>9}{:>9}{:>9}{:>12}{:>12}{:>11}{:>11}{:>8}\n", "scene", "Embree",
                   "best", "ours ms", "best", "ratio", "of best", "rays", "our rays", "mean", "our mean",
                   "PSNR");
    }
    json results = json::array();
    for (const std::string& name : o.scenes) {
        results.push_back(measure(device, o, name));
        if (!o.json) printRow(results.back());
    }
    if (!o.json) return;
    const json object{{"embree", embree},   {"device", device.info().name}, {"driver", device.info().driver},
                      {"width", o.width},   {"height", o.height},           {"max_depth", o.maxDepth},
                      {"rounds", o.rounds}, {"frames", o.frames},           {"results", results}};
    fmt::print("{}\n", object.dump(2));
}

void addOptions(CLI::App& app, Options& o) {
    app.add_option("--scene", o.scenes, "Diffuse built-in scenes (cornell heavy)");
    app.add_option("--device", o.device, "Where ours runs: name, index or 'cpu' (cpu)");
    app.add_option("--width", o.width, "Pixels (640)")->check(CLI::Range(1, 65535));
    app.add_option("--height", o.height, "Pixels (360)")->check(CLI::Range(1, 65535));
    app.add_option("--max-depth", o.maxDepth, "Bounces (4)")->check(CLI::Range(0, 1024));
    app.add_option("--rounds", o.rounds, "Turns of each (6)")->check(CLI::Range(1, 100000));
    app.add_option("--frames", o.frames, "Samples per pixel in a turn (4)")->check(CLI::Range(1, 100000));
    app.add_option("--warmup", o.warmup, "Samples of each before the first turn (2)")
        ->check(CLI::Range(1, 100000));
    app.add_flag("--json", o.json, "One JSON object on stdout");
}

int runProgram(int argc, char** argv) {
    CLI::App app("Our path tracer against a native one on Embree, on the same paths.", "limpid_yardstick");
    Options options;
    addOptions(app, options);
    try {
        app.parse(argc, argv);
        run(options);
        return static_cast<int>(ExitCode::Done);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? static_cast<int>(ExitCode::Done) : static_cast<int>(ExitCode::Usage);
    } catch (const Error& error) {
        log::error("{}", error.what());
        return static_cast<int>(error.code());
    } catch (const std::exception& error) {
        log::error("{}", error.what());
        return static_cast<int>(ExitCode::Failed);
    }
}

}  // namespace
}  // namespace limpid::bench

int main(int argc, char** argv) {
    return limpid::bench::runProgram(argc, argv);
}
