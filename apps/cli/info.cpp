// `limpid info`: lists devices with features and limits, integrators, denoisers, built-in scenes and every
// parameter; or the content of a scene.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/console/json_text.h"
#include "commands.h"
#include "gpu/vulkan/device.h"
#include "info_scene.h"
#include "renderer/layers/layers.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"
#include "scene/builtin/builtin.h"
#include "scene/device/trees/tracer.h"

namespace limpid::cli {
namespace {

using nlohmann::json;

json devicesJson(const std::vector<gpu::DeviceInfo>& devices) {
    json list = json::array();
    for (const gpu::DeviceInfo& device : devices) {
        json features = json::object(), limits = json::object();
        for (const auto& [name, present] : device.features) features[name] = present;
        for (const auto& [name, value] : device.limits) limits[name] = value;
        list.push_back({{"index", device.index},
                        {"name", device.name},
                        {"type", nameOf(device.type)},
                        {"driver", device.driver},
                        {"api_version", device.apiVersion},
                        {"memory_bytes", device.memoryBytes},
                        {"usable", device.usable},
                        {"why_not", device.whyNot},
                        {"tracer", scene::toString(scene::automaticTracer(device))},
                        {"kpcn", denoise::toString(denoise::kpcnPrecision(device, true))},
                        {"features", features},
                        {"limits", limits}});
    }
    return list;
}

json parametersJson() {
    json list = json::array();
    for (const ParamGroup& group : paramGroups()) {
        for (const ParamInfo& info : group.infos) {
            list.push_back({{"name", group.name + "." + info.name},
                            {"default", toString(info.defaultValue)},
                            {"minimum", info.minimum},
                            {"maximum", info.maximum},
                            {"unit", info.unit},
                            {"help", info.help}});
        }
    }
    return list;
}

json presetsJson() {
    json list = json::array();
    for (const Preset& preset : presets()) {
        list.push_back({{"name", preset.name},
                        {"help", preset.help},
                        {"integrators", preset.integrators},
                        {"denoisers", preset.denoisers},
                        {"jitter", toString(preset.jitter)},
                        {"progressive", preset.progressive},
                        {"parameters", preset.assignments}});
    }
    return list;
}

json integratorsJson() {
    json list = json::array();
    for (const Integrator integrator : integrators())
        list.push_back({{"name", nameOf(integrator)},
                        {"help", helpOf(integrator)},
                        {"can_be_denoised", canBeDenoised(integrator)}});
    return list;
}

json denoisersJson() {
    json list = json::array();
    for (const denoise::Denoiser& denoiser : denoise::denoisers())
        list.push_back({{"name", denoiser.name}, {"help", denoiser.help}});
    return list;
}

json scenesJson() {
    json list = json::array();
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) {
        list.push_back({{"name", "builtin:" + info.name}, {"help", info.help}});
    }
    return list;
}

void printDevice(const gpu::DeviceInfo& device) {
    fmt::print("{}: {} ({}, {}, Vulkan {}, {:.1f} GiB)\n", device.index, device.name, nameOf(device.type),
               device.driver, device.apiVersion,
               static_cast<double>(device.memoryBytes) / (1024.0 * 1024.0 * 1024.0));
    if (!device.usable) fmt::print("   not usable: {}\n", device.whyNot);
    fmt::print("   {:<40} {}\n", "--tracer auto", scene::toString(scene::automaticTracer(device)));
    fmt::print("   {:<40} {}\n", "--denoiser kpcn", denoise::toString(denoise::kpcnPrecision(device, true)));
    for (const auto& [name, present] : device.features)
        fmt::print("   {:<40} {}\n", name, present ? "yes" : "no");
    for (const auto& [name, value] : device.limits) fmt::print("   {:<40} {}\n", name, value);
}

void printText(const std::vector<gpu::DeviceInfo>& devices) {
    fmt::print("Devices\n");
    if (devices.empty())
        fmt::print("none; the Debian package mesa-vulkan-drivers has one that runs on any CPU\n");
    for (const gpu::DeviceInfo& device : devices) printDevice(device);
    fmt::print("\nIntegrators (--integrator)\n");
    for (const Integrator integrator : integrators())
        fmt::print("{:<10} {}\n", nameOf(integrator), helpOf(integrator));
    fmt::print("\nDenoisers (--denoiser), of path, direct and ao\n{:<10} the integrator alone\n", "none");
    for (const denoise::Denoiser& denoiser : denoise::denoisers())
        fmt::print("{:<10} {}\n", denoiser.name, denoiser.help);
    fmt::print(
        "\nTracers (--tracer)\n"
        "compute   our own tree in a compute shader; every device\n"
        "hardware  the driver's ray-tracing pipeline; devices with VK_KHR_ray_tracing_pipeline\n\nBuilt-in "
        "scenes\n");
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) {
        fmt::print("{:<28} {}\n", "builtin:" + info.name, info.help);
    }
    fmt::print("\nLayers (--aov)\n");
    for (const LayerInfo& layer : layerTable) fmt::print("{:<16} {}\n", layer.name, layer.help);
    fmt::print("\nParameters (--set group.name=value)\n");
    for (const ParamGroup& group : paramGroups()) {
        for (const ParamInfo& info : group.infos) {
            fmt::print("{:<28} default {}, {} to {} {}\n   {}\n", group.name + "." + info.name,
                       toString(info.defaultValue), info.minimum, info.maximum, info.unit, info.help);
        }
    }
    fmt::print("\nPresets (--preset)\n");
    for (const Preset& preset : presets()) {
        fmt::print("{}\n   {}\n   --integrator {} --denoiser {} --jitter {}{} --set {}\n", preset.name,
                   preset.help, fmt::join(preset.integrators, " or "), fmt::join(preset.denoisers, " or "),
                   toString(preset.jitter), preset.progressive ? " --progressive" : "",
                   fmt::join(preset.assignments, " --set "));
    }
}

}  // namespace

void addInfoCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("info",
                                           "List devices, integrators, denoisers, built-in scenes and all "
                                           "parameters, or the contents of a scene");
    auto asJson = std::make_shared<bool>(false);
    auto scene = std::make_shared<std::string>();
    command->add_option("SCENE", *scene, "Show the cameras, animations, lights and sizes of this scene");
    command->add_flag("--json", *asJson, "Print one JSON object on stdout");
    command->callback([asJson, scene] {
        if (!scene->empty()) return printSceneInfo(*scene, *asJson);
        const std::vector<gpu::DeviceInfo> devices = gpu::enumerateDevices();
        if (!*asJson) return printText(devices);
        const json object{{"version", LIMPID_VERSION},
                          {"devices", devicesJson(devices)},
                          {"integrators", integratorsJson()},
                          {"denoisers", denoisersJson()},
                          {"tracers", {"compute", "hardware"}},
                          {"scenes", scenesJson()},
                          {"layers", layerNames()},
                          {"parameters", parametersJson()},
                          {"presets", presetsJson()}};
        fmt::print("{}\n", jsonText(object));
    });
}

}  // namespace limpid::cli
