// The Vulkan device: choosing it, creating it, and memory on it. Everything below src/gpu is the only code
// that calls Vulkan; other folders see Device, Buffer, Image and FrameGraph.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "gpu/graph/shader.h"

namespace limpid::gpu {

/// The device does nothing any more: its driver has crashed, or has been reset. All that was made on it is
/// gone; a new Device may work.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

/// What `limpid info` lists of a physical device.
struct DeviceInfo {
    uint32_t index = 0;
    std::string name;
    std::string type;    ///< "discrete", "integrated", "virtual", "cpu", "other"
    std::string driver;  ///< driver name and version
    std::string apiVersion;
    uint64_t memoryBytes = 0;  ///< the largest device-local heap
    bool usable = false;
    bool rayTracing = false;  ///< has ray-tracing pipelines and acceleration structures
    /// ... and, as far as can be told, hardware for them: some drivers emulate them on shader cores.
    bool rayTracingCores = false;
    /// VK_NV_cooperative_matrix: a subgroup of 32 multiplies 16x16 halves and adds them up in single
    /// precision.
    bool cooperativeMatrices = false;
    std::string whyNot;                                    ///< the missing features, if it is not usable
    std::vector<std::pair<std::string, bool>> features;    ///< required and optional ones, by Vulkan name
    std::vector<std::pair<std::string, uint64_t>> limits;  ///< those that Limpid heeds, by Vulkan name
};

struct DeviceOptions {
    /// "" picks the best usable device (discrete before integrated before cpu); "cpu" a software device; a
    /// number the device of that index; anything else the first device whose name contains it, ignoring case.
    std::string select;
    /// Khronos validation layer with synchronisation validation. Every message is logged and counted. Also
    /// switched on by the environment variable LIMPID_VALIDATION=1. Throws Error if asked for and not
    /// installed.
    bool validation = false;
    /// Of the Vulkan instance, as the window system names them (glfwGetRequiredInstanceExtensions): the
    /// device shall show pictures in windows (gpu/present/presenter.h). Those that are missing are left out,
    /// and then it cannot.
    std::vector<std::string> surfaceExtensions;
};

/// All Vulkan devices of this machine; empty if there is no Vulkan loader or driver.
std::vector<DeviceInfo> enumerateDevices();

class Device;

/// Device memory for storage buffers, texel buffers and uniforms. Move-only; frees itself.
class Buffer {
  public:
    Buffer();
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;
    ~Buffer();

    uint64_t size() const;                      ///< bytes, as asked for
    std::optional<Format> texelFormat() const;  ///< set if it is a texel buffer
    explicit operator bool() const { return impl_ != nullptr; }

    struct Impl;  ///< gpu/vulkan/memory/buffer.h, for this folder only
    explicit Buffer(std::unique_ptr<Impl> impl);
    const Impl* impl() const { return impl_.get(); }

  private:
    std::unique_ptr<Impl> impl_;
};

class Device {
  public:
    explicit Device(const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const;
    bool isCpu() const { return info().type == "cpu"; }
    /// Messages of the validation layer so far (warnings and errors, not performance advice). Tests want 0.
    uint64_t validationMessages() const;
    /// Device memory that is allocated now, staging and all.
    uint64_t allocatedBytes() const;
    uint64_t maxTexelBufferElements() const;
    uint64_t maxBufferBytes() const;  ///< the smaller of maxBufferSize and maxMemoryAllocationSize

    /// A device-local storage texel buffer holding `data` (at least one texel; empty data gives one zero
    /// texel). Throws Error naming the limit if the data exceeds maxTexelBufferElements or the device's
    /// allocation limits.
    Buffer createTexelBuffer(const std::string& name, Format format, std::span<const std::byte> data);
    /// A device-local storage buffer of `bytes` bytes, zeroed, or holding `data`.
    Buffer createStorageBuffer(const std::string& name, uint64_t bytes);
    Buffer createStorageBuffer(const std::string& name, std::span<const std::byte> data);
    /// Copies the whole buffer to the host; waits for the device.
    std::vector<std::byte> download(const Buffer& buffer);

    void waitIdle();

    struct Impl;
    Impl& impl() { return *impl_; }

  private:
    std::unique_ptr<Impl> impl_;
};

template <typename T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span<const T>(values));
}

}  // namespace limpid::gpu
