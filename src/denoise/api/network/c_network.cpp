// The C interface of the kernel-predicting network (limpid/neural.h).
#include <filesystem>
#include <memory>

#include "denoise/api/c_device.h"
#include "denoise/api/c_guard.h"
#include "denoise/api/host_pixels.h"
#include "denoise/api/network/installed_weights.h"
#include "denoise/api/network/network_frame.h"
#include "denoise/api/parameter_numbers.h"
#include "denoise/kpcn/kpcn.h"
#include "limpid/neural.h"

using namespace limpid;
using namespace limpid::denoise;

struct limpid_network {
    limpid_network(const limpid_device_desc* on, const limpid_network_desc& desc);

    /// Loads the weights anew where the parameter asks for others.
    void set(std::string_view name, double value);
    void denoise(const limpid_network_frame& frame);
    std::unique_ptr<const KpcnNetwork> load(const KpcnSettings& wanted) const;

    MessageCallback messages;
    std::shared_ptr<gpu::Device> device;
    std::filesystem::path file;  ///< of weights; empty: those that are installed
    float farDepth;
    KpcnSettings settings;
    std::unique_ptr<const KpcnNetwork> network;
    gpu::FrameGraph graph{{.framesInFlight = 1, .prefix = "limpid/", .timestamps = false}};
};

namespace {

[[noreturn]] void failUnknown(std::string_view name) {
    throw UsageError(formatText("the network has no parameter '{}'", name));
}

MessageCallback messagesOf(const limpid_device_desc* desc) {
    if (!desc) return {};
    const limpid_device_desc whole = wholeStruct(desc, "limpid_device_desc");
    return callbackOf(whole.message, whole.message_user);
}

const std::vector<InstanceParameter>& allParameters() {
    static const std::vector<InstanceParameter> all = [] {
        std::vector<InstanceParameter> list;
        listParameters(kpcnParams(), list);
        return list;
    }();
    return all;
}

}  // namespace

limpid_network::limpid_network(const limpid_device_desc* on, const limpid_network_desc& desc)
    : messages(messagesOf(on)),
      device(openDevice(on)),
      file(desc.weights ? desc.weights : ""),
      farDepth(desc.far_depth > 0.0f ? desc.far_depth : 1e9f),
      network(load(settings)) {}

std::unique_ptr<const KpcnNetwork> limpid_network::load(const KpcnSettings& wanted) const {
    return std::make_unique<KpcnNetwork>(*device,
                                         readKpcnWeights(file.empty() ? installedWeights(wanted) : file),
                                         kpcnPrecision(device->info(), wanted.half));
}

void limpid_network::set(std::string_view name, double value) {
    KpcnSettings wanted = settings;
    if (!setNumber(kpcnParams(), wanted, name, value)) failUnknown(name);
    const bool otherFile = file.empty() && wanted.cis565 != settings.cis565;
    if (otherFile || kpcnPrecision(device->info(), wanted.half) != network->precision())
        network = load(wanted);
    settings = wanted;
}

void limpid_network::denoise(const limpid_network_frame& frame) {
    checkOutput(frame.color, "color");
    required(frame.color.data, "color.data");
    const NetworkPixels pixels = readNetworkFrame(frame, farDepth, messages);
    graph.beginFrame();
    const DenoiserInput input = uploadNetworkFrame(graph, pixels);
    const gpu::ImageHandle clean = filterKpcn(graph, input, settings, *network);
    graph.execute(*device);
    writePixels(frame.color, graph.downloadFloat(*device, clean), frame.width, frame.height, "color");
}

extern "C" {

uint32_t limpid_network_version(void) {
    return 10000 * LIMPID_VERSION_MAJOR + 100 * LIMPID_VERSION_MINOR + LIMPID_VERSION_PATCH;
}

const char* limpid_network_last_error(void) {
    return lastErrorText();
}

limpid_result limpid_network_create(const limpid_device_desc* device, const limpid_network_desc* desc,
                                    limpid_network** network) {
    return guarded([&] {
        required(network, "network") = nullptr;
        const limpid_network_desc d = desc ? wholeStruct(desc, "limpid_network_desc") : limpid_network_desc{};
        *network = new limpid_network(device, d);
    });
}

void limpid_network_destroy(limpid_network* network) {
    delete network;
}

const char* limpid_network_device_name(const limpid_network* network) {
    return network ? network->device->info().name.c_str() : "";
}

const char* limpid_network_precision(const limpid_network* network) {
    return network ? toString(network->network->precision()).data() : "";  // of a string literal
}

limpid_result limpid_network_parameter(uint32_t index, limpid_parameter* parameter) {
    return guarded([&] {
        const std::vector<InstanceParameter>& all = allParameters();
        if (index >= all.size()) throw UsageError(formatText("the network has {} parameters", all.size()));
        required(parameter, "parameter") = describe(all[index]);
    });
}

limpid_result limpid_network_set(limpid_network* network, const char* name, double value) {
    return guarded([&] { required(network, "network").set(&required(name, "name"), value); });
}

limpid_result limpid_network_get(const limpid_network* network, const char* name, double* value) {
    return guarded([&] {
        const KpcnSettings& settings = required(network, "network").settings;
        const std::string_view wanted = &required(name, "name");
        const std::optional<double> found = getNumber(kpcnParams(), settings, wanted);
        if (!found) failUnknown(wanted);
        required(value, "value") = *found;
    });
}

limpid_result limpid_network_denoise(limpid_network* network, const limpid_network_frame* frame) {
    return guarded([&] { required(network, "network").denoise(wholeStruct(frame, "limpid_network_frame")); });
}

}  // extern "C"
