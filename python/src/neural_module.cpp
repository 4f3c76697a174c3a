// limpid._neural: the network's C interface (limpid/neural.h) for Python. limpid/_network.py checks arguments
// and documents them.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "c_interface.h"
#include "limpid/neural.h"

namespace py = pybind11;

namespace {

using namespace limpid::python;

/// Throws Failure if a call failed. Must run on the same thread as the call, since the error text is per
/// thread.
void check(limpid_result result) {
    if (result != LIMPID_OK) throw Failure(limpid_network_last_error(), result);
}

class Network {
  public:
    Network(const std::string& select, const std::string& weights) {
        limpid_device_desc device{};
        device.size = sizeof device;
        device.select = select.c_str();
        limpid_network_desc desc{};
        desc.size = sizeof desc;
        desc.weights = weights.c_str();
        limpid_network* network = nullptr;
        check(limpid_network_create(&device, &desc, &network));
        handle_.reset(network);
    }

    std::string deviceName() const { return limpid_network_device_name(handle_.get()); }
    std::string precision() {
        const std::lock_guard lock(mutex_);
        return limpid_network_precision(handle_.get());
    }

    /// `inputs`: limpid_network_input and a float array of (height, width, components). Returns (height,
    /// width, 3).
    Array denoise(uint32_t width, uint32_t height, uint32_t samples,
                  const std::vector<std::pair<uint32_t, Array>>& inputs) {
        limpid_network_frame frame{};
        frame.size = sizeof frame;
        frame.width = width;
        frame.height = height;
        frame.samples = samples;
        for (const auto& [input, array] : inputs) {
            if (input >= LIMPID_NETWORK_INPUT_MAX) throw std::invalid_argument("there is no such input");
            checkReadable(array, width, height);
            frame.inputs[input] = hostImage<limpid_host_image>(array.data(), array);
        }
        Array result({py::ssize_t{height}, py::ssize_t{width}, py::ssize_t{3}});
        frame.color = hostImage<limpid_host_output>(result.mutable_data(), result);
        const py::gil_scoped_release release;
        const std::lock_guard lock(mutex_);
        check(limpid_network_denoise(handle_.get(), &frame));
        return result;
    }

    void set(const std::string& name, double value) {
        const std::lock_guard lock(mutex_);
        check(limpid_network_set(handle_.get(), name.c_str(), value));
    }
    double get(const std::string& name) {
        const std::lock_guard lock(mutex_);
        double value = 0.0;
        check(limpid_network_get(handle_.get(), name.c_str(), &value));
        return value;
    }

  private:
    struct Destroy {
        void operator()(limpid_network* network) const { limpid_network_destroy(network); }
    };
    std::mutex mutex_;  ///< one thread at a time may use a network
    std::unique_ptr<limpid_network, Destroy> handle_;
};

py::dict inputs() {
    const std::pair<const char*, limpid_network_input> all[] = {
        {"diffuse", LIMPID_NETWORK_INPUT_DIFFUSE},
        {"specular", LIMPID_NETWORK_INPUT_SPECULAR},
        {"emission", LIMPID_NETWORK_INPUT_EMISSION},
        {"albedo", LIMPID_NETWORK_INPUT_ALBEDO},
        {"normal", LIMPID_NETWORK_INPUT_NORMAL},
        {"depth", LIMPID_NETWORK_INPUT_DEPTH},
        {"diffuse_variance", LIMPID_NETWORK_INPUT_DIFFUSE_VARIANCE},
        {"specular_variance", LIMPID_NETWORK_INPUT_SPECULAR_VARIANCE},
        {"albedo_variance", LIMPID_NETWORK_INPUT_ALBEDO_VARIANCE},
        {"normal_variance", LIMPID_NETWORK_INPUT_NORMAL_VARIANCE},
        {"depth_variance", LIMPID_NETWORK_INPUT_DEPTH_VARIANCE}};
    py::dict dict;
    for (const auto& [name, value] : all) dict[name] = static_cast<int>(value);
    return dict;
}

}  // namespace

PYBIND11_MODULE(_neural, m) {
    translateFailures();
    using Unlocked = py::call_guard<py::gil_scoped_release>;
    m.attr("INPUTS") = inputs();
    m.def("parameters", [] { return listParameters(limpid_network_parameter); });
    py::class_<Network>(m, "Network")
        .def(py::init<const std::string&, const std::string&>(), Unlocked())
        .def("device_name", &Network::deviceName)
        .def("precision", &Network::precision, Unlocked())
        .def("denoise", &Network::denoise)
        .def("set", &Network::set, Unlocked())
        .def("get", &Network::get, Unlocked());
}
