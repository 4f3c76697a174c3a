// Limpid's denoisers for C++17: wraps the C interface of denoise.h in objects with destructors, exceptions
// instead of result codes, and structs with default values. Everything is inline: only C symbols are linked.
//
//     limpid::Device device;
//     limpid::DenoiserDesc desc(1280, 720);
//     limpid::Denoiser denoiser(device, desc);
//     limpid::HostFrame frame;
//     frame.inputs[LIMPID_INPUT_RADIANCE] = {pixels, 3};
//     ...
//     denoiser.denoise(frame);
//
// See denoise.h for members, units, ranges and rules. For Vulkan programs: denoise_vulkan.hpp.
#ifndef LIMPID_DENOISE_HPP
#define LIMPID_DENOISE_HPP

#include <limpid/denoise.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace limpid {
inline namespace v0 {

/// A failure: result() is its kind, what() describes it.
class Error : public std::runtime_error {
  public:
    Error(limpid_result result, const char* message) : std::runtime_error(message), result_(result) {}
    limpid_result result() const noexcept { return result_; }

  private:
    limpid_result result_;
};

/// Throws Error unless `result` is LIMPID_OK.
inline void check(limpid_result result) {
    if (result != LIMPID_OK) throw Error(result, limpid_last_error());
}

/// A struct of the C interface with its size set and default values.
template <typename T>
struct Sized : T {
    Sized() noexcept : T{} { this->size = sizeof(T); }
};

using DeviceDesc = Sized<limpid_device_desc>;
using HostFrame = Sized<limpid_host_frame>;

struct DenoiserDesc : Sized<limpid_denoiser_desc> {
    DenoiserDesc() = default;
    DenoiserDesc(uint32_t wide, uint32_t high, limpid_method by = LIMPID_METHOD_SVGF) noexcept {
        width = wide;
        height = high;
        method = by;
    }
};

/// A Vulkan device that Limpid owns, or the caller's (adopt() in denoise_vulkan.hpp). Must outlive its
/// denoisers.
class Device {
  public:
    Device() : Device(DeviceDesc()) {}
    explicit Device(const limpid_device_desc& desc) {
        limpid_device* made = nullptr;
        check(limpid_device_create(&desc, &made));
        handle_.reset(made);
    }
    /// Takes ownership of a handle created by the C interface.
    explicit Device(limpid_device* owned) noexcept : handle_(owned) {}

    limpid_device* get() const noexcept { return handle_.get(); }
    std::string name() const { return limpid_device_name(get()); }

    /// Returns the driver's compiled pipelines. Store them, and load them in the next run before the first
    /// denoiser is created.
    std::vector<std::byte> pipelineCache() const {
        size_t size = 0;
        check(limpid_device_pipeline_cache(get(), nullptr, &size));
        std::vector<std::byte> data(size);
        if (size != 0) check(limpid_device_pipeline_cache(get(), data.data(), &size));
        data.resize(size);
        return data;
    }
    void loadPipelineCache(const std::vector<std::byte>& data) {
        check(limpid_device_load_pipeline_cache(get(), data.data(), data.size()));
    }

  private:
    struct Destroy {
        void operator()(limpid_device* device) const noexcept { limpid_device_destroy(device); }
    };
    std::unique_ptr<limpid_device, Destroy> handle_;
};

class Denoiser {
  public:
    Denoiser(const Device& device, const limpid_denoiser_desc& desc) {
        limpid_denoiser* made = nullptr;
        check(limpid_denoiser_create(device.get(), &desc, &made));
        handle_.reset(made);
    }

    limpid_denoiser* get() const noexcept { return handle_.get(); }

    /// Denoises one frame in host memory and waits for it.
    void denoise(const limpid_host_frame& frame) { check(limpid_denoise_host(get(), &frame)); }

    void resize(uint32_t width, uint32_t height) { check(limpid_denoiser_resize(get(), width, height)); }
    /// Marks a cut: the next frame starts without history.
    void reset() { check(limpid_denoiser_reset(get())); }

    /// Sets or returns a parameter of the method by name, such as "svgf.alpha".
    void set(const std::string& name, double value) {
        check(limpid_denoiser_set(get(), name.c_str(), value));
    }
    double parameter(const std::string& name) const {
        double value = 0.0;
        check(limpid_denoiser_get(get(), name.c_str(), &value));
        return value;
    }

    /// Returns the device time of each pass; empty unless the description enabled timings. The names are valid
    /// until the next call.
    std::vector<limpid_timing> timings() {
        uint32_t count = 0;
        check(limpid_denoiser_timings(get(), nullptr, &count));
        std::vector<limpid_timing> all(count);
        if (count != 0) check(limpid_denoiser_timings(get(), all.data(), &count));
        all.resize(count);
        return all;
    }

  private:
    struct Destroy {
        void operator()(limpid_denoiser* denoiser) const noexcept { limpid_denoiser_destroy(denoiser); }
    };
    std::unique_ptr<limpid_denoiser, Destroy> handle_;
};

/// Returns the parameters of a method.
inline std::vector<limpid_parameter> parameters(limpid_method method) {
    std::vector<limpid_parameter> all;
    limpid_parameter parameter{};
    while (limpid_method_parameter(method, static_cast<uint32_t>(all.size()), &parameter) == LIMPID_OK)
        all.push_back(parameter);
    if (all.empty()) check(limpid_method_parameter(method, 0, &parameter));
    return all;
}

/// Returns the device memory in bytes that a denoiser allocates for its images. Needs no device.
inline uint64_t deviceMemory(const limpid_denoiser_desc& desc, bool forGpu = true) {
    uint64_t bytes = 0;
    check(limpid_denoiser_memory(&desc, forGpu ? 1 : 0, &bytes));
    return bytes;
}

static_assert(std::is_nothrow_move_constructible_v<Device> && !std::is_copy_constructible_v<Device>);
static_assert(std::is_nothrow_move_constructible_v<Denoiser> && !std::is_copy_constructible_v<Denoiser>);

}  // namespace v0
}  // namespace limpid
#endif
