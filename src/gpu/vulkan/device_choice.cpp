// Selects the device that a user asks for.
#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include "base/error.h"
#include "base/text/format.h"
#include "base/text/lower_case.h"
#include "gpu/vulkan/physical_device.h"

namespace limpid::gpu {
namespace {

std::string describe(const std::vector<DeviceInfo>& infos) {
    std::string text;
    for (const DeviceInfo& info : infos) {
        text += formatText("\n  {}: {} ({}){}", info.index, info.name, nameOf(info.type),
                           info.usable ? "" : ", unusable: it lacks " + info.whyNot);
    }
    return text;
}

bool matches(const DeviceInfo& info, const std::string& select) {
    if (select.empty()) return true;
    if (lowerCase(select) == "cpu") return info.type == DeviceType::Cpu;
    const bool number = std::ranges::all_of(select, [](unsigned char c) { return std::isdigit(c); });
    if (number) return std::to_string(info.index) == select;
    return lowerCase(info.name).find(lowerCase(select)) != std::string::npos;
}

}  // namespace

std::string_view nameOf(DeviceType type) {
    constexpr std::string_view names[] = {"discrete", "integrated", "virtual", "other", "cpu"};
    return names[static_cast<size_t>(type)];
}

size_t chooseIndex(const std::vector<DeviceInfo>& infos, const std::string& select) {
    if (infos.empty()) {
        throw Unsupported(
            "there is no Vulkan device: no Vulkan loader or driver was found. For the CPU, install "
            "libvulkan1 and mesa-vulkan-drivers (the Debian packages' names)");
    }
    std::optional<size_t> best;
    bool anyMatch = false;
    for (size_t i = 0; i < infos.size(); ++i) {
        if (!matches(infos[i], select)) continue;
        anyMatch = true;
        if (infos[i].usable && (!best || (select.empty() && infos[i].type < infos[*best].type))) best = i;
    }
    if (best) return *best;
    const std::string list = describe(infos);
    if (select.empty()) throw Unsupported("no Vulkan device here is usable:" + list);
    throw Unsupported(formatText("{} '{}'; there are:{}",
                                 anyMatch ? "no usable Vulkan device is" : "no Vulkan device matches", select,
                                 list));
}

PhysicalDevice choose(std::vector<PhysicalDevice> devices, const std::string& select) {
    std::vector<DeviceInfo> infos;
    for (const PhysicalDevice& device : devices) infos.push_back(device.info);
    return std::move(devices[chooseIndex(infos, select)]);
}

}  // namespace limpid::gpu
