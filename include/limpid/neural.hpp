// Limpid's kernel-predicting network for C++17: the C interface of neural.h with an object that cleans up
// after itself, exceptions in place of result codes, and structs that begin with their defaults. All of it is
// inline: what is linked is liblimpid-neural alone.
//
//     limpid::Network network;
//     limpid::NetworkFrame frame(1280, 720);
//     frame.inputs[LIMPID_NETWORK_INPUT_DIFFUSE] = {diffuse, 3};
//     ...
//     frame.color = {clean, 3};
//     network.denoise(frame);
//
// Members, units, ranges and rules are those of neural.h.
#ifndef LIMPID_NEURAL_HPP
#define LIMPID_NEURAL_HPP

#include <limpid/neural.h>

#include <limpid/denoise.hpp>

namespace limpid {
inline namespace v0 {

/// Throws Error unless `result`, of a limpid_network_* function, is LIMPID_OK.
inline void checkNetwork(limpid_result result) {
    if (result != LIMPID_OK) throw Error(result, limpid_network_last_error());
}

using NetworkDesc = Sized<limpid_network_desc>;

struct NetworkFrame : Sized<limpid_network_frame> {
    NetworkFrame() = default;
    NetworkFrame(uint32_t wide, uint32_t high, uint32_t samplesPerPixel = 32) noexcept {
        width = wide;
        height = high;
        samples = samplesPerPixel;
    }
};

/// A network on a device of its own.
class Network {
  public:
    Network() : Network(DeviceDesc(), NetworkDesc()) {}
    explicit Network(const limpid_device_desc& device) : Network(device, NetworkDesc()) {}
    Network(const limpid_device_desc& device, const limpid_network_desc& desc) {
        limpid_network* made = nullptr;
        checkNetwork(limpid_network_create(&device, &desc, &made));
        handle_.reset(made);
    }

    limpid_network* get() const noexcept { return handle_.get(); }
    std::string deviceName() const { return limpid_network_device_name(get()); }
    /// How it is computed.
    std::string precision() const { return limpid_network_precision(get()); }

    /// Denoises one frame in host memory, by itself, and waits for it.
    void denoise(const limpid_network_frame& frame) { checkNetwork(limpid_network_denoise(get(), &frame)); }

    /// A parameter by name: "kpcn.levels".
    void set(const std::string& name, double value) { checkNetwork(limpid_network_set(get(), name.c_str(), value)); }
    double parameter(const std::string& name) const {
        double value = 0.0;
        checkNetwork(limpid_network_get(get(), name.c_str(), &value));
        return value;
    }

  private:
    struct Destroy {
        void operator()(limpid_network* network) const noexcept { limpid_network_destroy(network); }
    };
    std::unique_ptr<limpid_network, Destroy> handle_;
};

inline std::vector<limpid_parameter> networkParameters() {
    std::vector<limpid_parameter> all;
    limpid_parameter parameter{};
    while (limpid_network_parameter(static_cast<uint32_t>(all.size()), &parameter) == LIMPID_OK)
        all.push_back(parameter);
    return all;
}

static_assert(std::is_nothrow_move_constructible_v<Network> && !std::is_copy_constructible_v<Network>);

}  // namespace v0
}  // namespace limpid
#endif
