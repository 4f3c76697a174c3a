// Tests the network's C++ wrapper: defaults, exceptions with their code, moves, parameters. Of Limpid it only
// links liblimpid-neural.
#include <cstdio>
#include <limpid/neural.hpp>
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
    const limpid::NetworkFrame frame(64, 32, 16);
    expect(frame.size == sizeof(limpid_network_frame), "a frame has its size");
    expect(frame.width == 64 && frame.height == 32 && frame.samples == 16, "the constructor sets");
    expect(frame.color.data == nullptr, "the rest is zero");
    expect(!limpid::networkParameters().empty(), "the network has parameters");

    limpid::DeviceDesc cpu;
    cpu.select = "cpu";
    limpid::NetworkDesc missing;
    missing.weights = "there is no such file";
    expect(resultOf([&] { limpid::Network(cpu, missing); }) == LIMPID_ERROR_UNREADABLE,
           "missing weights are refused");
    limpid::Network first(cpu);
    limpid::Network network = std::move(first);
    expect(first.get() == nullptr && network.get() != nullptr, "a network moves");
    expect(!network.deviceName().empty() && !network.precision().empty(), "it tells where and how it runs");
    expect(resultOf([&] { network.denoise(frame); }) == LIMPID_ERROR_INVALID_ARGUMENT,
           "a frame without inputs is refused");
    network.set("kpcn.levels", 2);
    expect(network.parameter("kpcn.levels") == 2.0, "a parameter keeps its value");
    expect(resultOf([&] { network.set("none", 1.0); }) == LIMPID_ERROR_INVALID_ARGUMENT,
           "an unknown one is refused");
    return faults == 0 ? 0 : 1;
}
