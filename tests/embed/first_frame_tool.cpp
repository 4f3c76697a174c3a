// Not a test, but a benchmark: measures how long the first frame of a denoiser takes in a Vulkan program, and
// the later ones, with and without limpid_warm_up() (docs/benchmarks.md, "The library").
//     limpid_first_frame DEVICE WIDTH HEIGHT [warm-up]
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "gpu/vulkan/device_impl.h"
#include "gpu/vulkan/memory/image.h"
#include "limpid/denoise_vulkan.hpp"

namespace {

using namespace limpid;

constexpr int laterFrames = 20;
constexpr float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr float perspective[16] = {1, 0, 0, 0, 0, -1.78f, 0, 0, 0, 0, -1, -1, 0, 0, -0.1f, 0};

/// Elapsed time, and processor time of all cores, in milliseconds. If other programs use the CPU too, only
/// processor times can be compared.
struct Time {
    double wall = 0, user = 0, system = 0;
};

Time now() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto milliseconds = [](const timeval& t) {
        return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
    };
    const auto clock = std::chrono::steady_clock::now().time_since_epoch();
    return {std::chrono::duration<double, std::milli>(clock).count(), milliseconds(used.ru_utime),
            milliseconds(used.ru_stime)};
}

Time timeOf(const std::function<void()>& work) {
    const Time start = now();
    work();
    const Time end = now();
    return {end.wall - start.wall, end.user - start.user, end.system - start.system};
}

void print(const char* what, const Time& time) {
    std::printf("%-22s %8.0f ms; on the host's cores %.0f ms in programs, %.0f ms in the kernel\n", what,
                time.wall, time.user, time.system);
}

/// The inputs of a frame: noisy light on a static wall.
struct Wall {
    Wall(gpu::Device& device, gpu::Extent extent) {
        const size_t pixels = size_t{extent.width} * extent.height;
        std::map<limpid_input, std::vector<float>> layers;
        for (const limpid_input input : {LIMPID_INPUT_RADIANCE, LIMPID_INPUT_ALBEDO, LIMPID_INPUT_NORMAL,
                                         LIMPID_INPUT_DEPTH, LIMPID_INPUT_MOTION})
            layers[input].assign(4 * pixels, 0.0f);
        for (size_t p = 0; p < pixels; ++p) {
            for (size_t c = 0; c < 3; ++c) {
                layers[LIMPID_INPUT_RADIANCE][4 * p + c] = static_cast<float>(p * 2654435761u % 1000) * 1e-3f;
                layers[LIMPID_INPUT_ALBEDO][4 * p + c] = 0.5f;
            }
            layers[LIMPID_INPUT_NORMAL][4 * p + 2] = 1.0f;
            layers[LIMPID_INPUT_DEPTH][4 * p] = 2.0f;
        }
        constexpr auto format = gpu::Format::RGBA32Float;
        std::map<limpid_input, gpu::ImageHandle> images;
        graph.beginFrame();
        for (const auto& [input, texels] : layers) {
            images[input] = graph.transient("wall/" + std::to_string(input), format, extent);
            graph.upload(images[input], gpu::bytesOf(texels));
        }
        const gpu::ImageHandle color = graph.transient("wall/color", format, extent);
        graph.upload(color, gpu::bytesOf(layers[LIMPID_INPUT_RADIANCE]));
        graph.execute(device);
        for (const auto& [input, handle] : images) frame.inputs[input] = imageOf(device, handle);
        frame.outputs[LIMPID_OUTPUT_COLOR] = imageOf(device, color);
        for (auto* view : {&frame.camera.view, &frame.camera.previous_view})
            std::ranges::copy(identity, *view);
        for (auto* projection : {&frame.camera.projection, &frame.camera.previous_projection})
            std::ranges::copy(perspective, *projection);
    }

    limpid_vulkan_image imageOf(gpu::Device& device, gpu::ImageHandle handle) {
        const gpu::Image& image = graph.imageOnDevice(device, handle);
        return limpid::image(image.image.get(), image.view.get(), VK_FORMAT_R32G32B32A32_SFLOAT,
                             VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                             VK_ACCESS_2_MEMORY_WRITE_BIT);
    }

    gpu::FrameGraph graph;  ///< owns the images
    VulkanFrame frame;
};

void measure(gpu::Device& device, gpu::Extent extent, bool warmUp) {
    const gpu::Context& program = *device.impl().context;
    const auto adopted = adopt(program.instance(), program.physicalDevice(), program.device(),
                               program.queueFamily(), gpu::systemLoader());
    DenoiserDesc desc(extent.width, extent.height, LIMPID_METHOD_SVGF);
    desc.timings = 1;
    std::optional<Denoiser> denoiser;
    std::printf("%s, %u x %u\n", device.info().name.c_str(), extent.width, extent.height);
    print("limpid_denoiser_create", timeOf([&] { denoiser.emplace(adopted, desc); }));
    Wall wall(device, extent);
    gpu::Transfer& queue = device.impl().transfer();
    if (warmUp)
        print(
            "limpid_warm_up", timeOf([&] {
                queue.run([&](VkCommandBuffer commands) { limpid::warmUp(*denoiser, commands, wall.frame); });
            }));
    std::vector<Time> frames;
    for (int i = 0; i <= laterFrames; ++i)
        frames.push_back(timeOf([&] {
            queue.run([&](VkCommandBuffer commands) { limpid::record(*denoiser, commands, wall.frame); });
        }));
    print("first frame", frames[0]);
    print("second frame", frames[1]);
    const auto median = [&](double Time::*part) {
        std::vector<double> values;
        for (size_t i = 1; i < frames.size(); ++i) values.push_back(frames[i].*part);
        std::nth_element(values.begin(), values.begin() + laterFrames / 2, values.end());
        return values[laterFrames / 2];
    };
    print("later frames, median", {median(&Time::wall), median(&Time::user), median(&Time::system)});
    for (const limpid_timing& pass : denoiser->timings())
        std::printf("    %-22s %8.3f ms on the device\n", pass.pass, pass.milliseconds);
    wall.frame.reset = 1;
    print("frame after a cut", timeOf([&] {
              queue.run([&](VkCommandBuffer commands) { limpid::record(*denoiser, commands, wall.frame); });
          }));
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 4) throw UsageError("limpid_first_frame DEVICE WIDTH HEIGHT [warm-up]");
    gpu::Device device(gpu::DeviceOptions{.select = argv[1]});
    measure(device, {static_cast<uint32_t>(std::stoul(argv[2])), static_cast<uint32_t>(std::stoul(argv[3]))},
            argc > 4);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "limpid_first_frame: %s\n", error.what());
    return 1;
}
