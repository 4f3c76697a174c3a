// Tests the C++ wrapper: defaults, exceptions with their code, moves, parameters.
#include <cstdio>
#include <limpid/denoise_vulkan.hpp>
#include <utility>

namespace {

int faults = 0;

void expect(bool holds, const char* what) {
    if (holds) return;
    std::printf("not so: %s\n", what);
    ++faults;
}

template <typename Action>
limpid_result resultOf(const Action& action) {
    try {
        action();
        return LIMPID_OK;
    } catch (const limpid::Error& error) {
        expect(*error.what() != '\0', "an error says something");
        return error.result();
    }
}

}  // namespace

int main() {
    const limpid::DenoiserDesc desc(64, 32, LIMPID_METHOD_ATROUS);
    expect(desc.size == sizeof(limpid_denoiser_desc), "a description has its size");
    expect(desc.width == 64 && desc.height == 32 && desc.method == LIMPID_METHOD_ATROUS,
           "the constructor sets");
    expect(desc.signals == 0 && desc.name == nullptr, "the rest is zero");
    expect(limpid::VulkanFrame().size == sizeof(limpid_vulkan_frame), "so has a frame");
    expect(limpid::deviceMemory(desc) > 0, "memory is known without a device");
    expect(!limpid::parameters(LIMPID_METHOD_SVGF).empty(), "SVGF has parameters");
    expect(
        resultOf([] { limpid::deviceMemory(limpid::DenoiserDesc(0, 32)); }) == LIMPID_ERROR_INVALID_ARGUMENT,
        "a picture without width is refused");
    expect(resultOf([] { limpid::adopt(limpid::VulkanDeviceDesc()); }) == LIMPID_ERROR_INVALID_ARGUMENT,
           "a device of nothing is refused");

    limpid::DeviceDesc cpu;
    cpu.select = "cpu";
    limpid::Device first(cpu);
    limpid::Device device = std::move(first);
    expect(first.get() == nullptr && device.get() != nullptr, "a device moves");
    expect(!device.name().empty(), "it has a name");
    limpid::Denoiser denoiser(device, desc);
    expect(resultOf([&] { denoiser.denoise(limpid::HostFrame()); }) == LIMPID_ERROR_INVALID_ARGUMENT,
           "a frame without inputs is refused");
    const limpid_parameter parameter = limpid::parameters(desc.method).front();
    denoiser.set(parameter.name, parameter.maximum);
    expect(denoiser.parameter(parameter.name) == parameter.maximum, "a parameter keeps its value");
    expect(resultOf([&] { denoiser.set("none", 1.0); }) == LIMPID_ERROR_INVALID_ARGUMENT,
           "an unknown one is refused");
    return faults == 0 ? 0 : 1;
}
