// `limpid bench kpcn`: milliseconds of the network's layers, and their operations per second compared with a
// plain matrix product.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "bench_product.comp.h"
#include "cli/console/json_text.h"
#include "denoise/kpcn/kpcn_params.h"
#include "lab/bench.h"
#include "lab/bench_scene.h"
#include "neural/convolutions.h"
#include "renderer/method/network_file.h"
#include "renderer/method/parameters.h"

namespace limpid::cli {
namespace {

using nlohmann::json;

struct KpcnBench {
    DeviceChoice device;
    std::string scene = "builtin:cornell", weights;
    std::vector<std::string> assignments;
    uint32_t width = 1920, height = 1080, frames = 10, warmup = 3, productSize = 8192;
    bool json = false;
};

/// Returns the operations per second of a product of square matrices on cooperative matrices; none if the
/// device has none.
std::optional<double> productRate(gpu::Device& device, uint32_t size) {
    if (!device.info().cooperativeMatrices) return std::nullopt;
    // Halves of 1 and of -0.5, two per word.
    const std::vector<uint32_t> ones(size_t{size} * size / 2, 0x3C00B800u);
    const gpu::Buffer left = device.createStorageBuffer("left", gpu::bytesOf(ones));
    const gpu::Buffer right = device.createStorageBuffer("right", gpu::bytesOf(ones));
    const gpu::Buffer result = device.createStorageBuffer("result", gpu::bytesOf(ones).size());
    gpu::FrameGraph graph;
    graph.beginFrame();
    for (int i = 0; i < 12; ++i)
        graph.dispatch({.pass = "product",
                        .shader = shaders::bench_product_comp,
                        .bindings = {{"left", &left}, {"right", &right}, {"result", &result}},
                        .params = gpu::paramsOf(size),
                        .constants = {},
                        .extent = {size / 8, size / 8}});
    graph.execute(device);
    std::vector<double> times;
    for (const gpu::PassTime& pass : graph.passTimes(device)) times.push_back(pass.milliseconds);
    times.erase(times.begin(), times.begin() + 2);
    return 2.0 * std::pow(size, 3) / (median(times) * 1e-3);
}

/// Returns the operations per second of a oneDNN convolution of the size of the hidden layers; none without
/// oneDNN, and on GPUs.
std::optional<double> convolutionRate([[maybe_unused]] const gpu::Device& device,
                                      [[maybe_unused]] const KpcnBench& o) {
#ifdef LIMPID_HAVE_ONEDNN
    if (!device.isCpu()) return std::nullopt;
    constexpr uint32_t channels = 100, padded = 112, taps = denoise::KPCN_TAPS * denoise::KPCN_TAPS;
    const std::vector<float> weights(size_t{taps} * channels * channels, 0.01f), bias(channels),
        last(taps * channels);
    neural::ConvolutionChain chain(
        {{channels, channels, weights, bias, true}, {channels, 1, last, {bias.data(), 1}, false}});
    const std::vector<float> input(size_t{padded} * o.width * o.height, 0.5f);
    std::vector<double> seconds;
    for (uint32_t i = 0; i < 4; ++i) {
        const auto start = std::chrono::steady_clock::now();
        chain.begin(input, o.width, o.height);
        seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    seconds.erase(seconds.begin());
    return 2.0 * taps * channels * channels * o.width * o.height / median(seconds);
#else
    return std::nullopt;
#endif
}

/// Returns the multiplications and additions of each convolution pass per pixel, counting real channels only.
std::map<std::string, double> operationsByPass(const denoise::KpcnWeights& weights) {
    std::map<std::string, double> result;
    const char* names[] = {"diffuse", "specular"};
    for (size_t side = 0; side < 2; ++side) {
        const std::vector<denoise::KpcnLayer>& layers = weights.sides[side];
        for (size_t i = 0; i < layers.size(); ++i) {
            const std::string step = i + 1 < layers.size() ? fmt::format("hidden {}", i + 1) : "kernel";
            const double count =
                2.0 * denoise::KPCN_TAPS * denoise::KPCN_TAPS * layers[i].inputs * layers[i].outputs;
            result[fmt::format("kpcn/{} {}", names[side], step)] = count;
            result[fmt::format("kpcn/{} layers", names[side])] += count;  // on CPUs one pass runs all layers
        }
    }
    return result;
}

/// Operations per second to compare the network with.
struct Yardsticks {
    std::optional<double> product, convolution;
};

struct Row {
    std::string pass;
    double milliseconds = 0.0, operations = 0.0;  ///< operations per frame
};

RenderSettings settingsOf(const KpcnBench& o) {
    RenderSettings settings;
    settings.extent = {o.width, o.height};
    settings.pipeline = parsePipeline("path", "kpcn");
    settings.jitter = Jitter::Off;
    for (const std::string& text : o.assignments) assign(settings, text);
    return settings;
}

std::vector<Row> measure(gpu::Device& device, const KpcnBench& o, RenderSettings& settings) {
    const auto file =
        o.weights.empty() ? shippedWeights(settings.denoisers.kpcn) : std::filesystem::path(o.weights);
    settings.networks = loadNetworks(device, settings.pipeline.denoiser, file, settings.denoisers);
    const std::map<std::string, double> operations = operationsByPass(denoise::readKpcnWeights(file));
    BenchScene scene(device, chosenTracer(o.device, device), {.scene = o.scene});
    std::vector<Row> rows;
    for (const auto& [pass, cost] : scene.measure(settings, o.warmup, o.frames)) {
        if (!pass.starts_with("kpcn/")) continue;
        const auto known = operations.find(pass);
        const double pixels = static_cast<double>(o.width) * o.height;
        rows.push_back(
            {pass, median(cost.milliseconds), known == operations.end() ? 0.0 : known->second * pixels});
    }
    Row all{"all", 0.0, 0.0};
    for (const Row& row : rows) {
        all.milliseconds += row.milliseconds;
        all.operations += row.operations;
    }
    rows.push_back(all);
    return rows;
}

double rateOf(const Row& row) {
    return row.operations / (row.milliseconds * 1e-3);
}

void print(const KpcnBench& o, const gpu::Device& device, const std::vector<Row>& rows,
           std::string_view precision, const Yardsticks& yardsticks) {
    fmt::print("{}, {}x{}, {}\n{:<28}{:>12}{:>12}\n", device.info().name, o.width, o.height, precision,
               "pass", "ms median", "GFLOP/s");
    for (const Row& row : rows)
        fmt::print("{:<28}{:>12.4f}{:>12.1f}\n", row.pass, row.milliseconds, rateOf(row) * 1e-9);
    const auto beside = [&](const std::string& what, std::optional<double> rate) {
        if (rate)
            fmt::print("{}: {:.1f} GFLOP/s; all of the network: {:.1f} % of that\n", what, *rate * 1e-9,
                       100.0 * rateOf(rows.back()) / *rate);
    };
    beside(fmt::format("a product of {0}x{0} matrices of halves", o.productSize), yardsticks.product);
    beside("nothing but a convolution of 100 to 100 channels by oneDNN", yardsticks.convolution);
}

void run(const KpcnBench& o) {
    if (o.productSize % 128 != 0) throw UsageError("--product-size is a multiple of 128");
    const OpenDevice device = openDevice(o.device);
    RenderSettings settings = settingsOf(o);
    const std::vector<Row> rows = measure(*device, o, settings);
    const std::string_view precision = denoise::toString(settings.networks.kpcn->precision());
    const Yardsticks yardsticks{productRate(*device, o.productSize), convolutionRate(*device, o)};
    if (!o.json) return print(o, *device, rows, precision, yardsticks);
    json passes = json::array();
    for (const Row& row : rows)
        passes.push_back(
            {{"pass", row.pass}, {"ms_median", row.milliseconds}, {"flop_per_second", rateOf(row)}});
    json object{{"device", device->info().name},
                {"driver", device->info().driver},
                {"scene", o.scene},
                {"precision", precision},
                {"width", o.width},
                {"height", o.height},
                {"frames", o.frames},
                {"passes", passes}};
    if (yardsticks.product) object["product_flop_per_second"] = *yardsticks.product;
    if (yardsticks.convolution) object["convolution_flop_per_second"] = *yardsticks.convolution;
    fmt::print("{}\n", jsonText(object));
}

}  // namespace

void addKpcnBench(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand(
        "kpcn",
        "Time the layers of the network, and compare its operations per second with a plain matrix product");
    auto o = std::make_shared<KpcnBench>();
    command->add_option("--scene", o->scene, "Scene to render (builtin:cornell)");
    command->add_option("--weights", o->weights, "Weights file instead of the one that comes with Limpid");
    command->add_option("--set", o->assignments,
                        "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command->add_option("--width", o->width, "Picture width, pixels (1920)")->check(CLI::Range(1, 16384));
    command->add_option("--height", o->height, "Picture height, pixels (1080)")->check(CLI::Range(1, 16384));
    command->add_option("--frames", o->frames, "Number of frames timed; more is steadier (10)")
        ->check(CLI::Range(1, 100000));
    command->add_option("--warmup", o->warmup, "Number of frames before timing starts (3)")
        ->check(CLI::Range(0, 100000));
    command
        ->add_option("--product-size", o->productSize,
                     "Rows of the matrices in the comparison with a plain product (8192)")
        ->check(CLI::Range(128, 16384));
    command->add_flag("--json", o->json, "Print one JSON object on stdout");
    addDeviceOptions(*command, o->device);
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
