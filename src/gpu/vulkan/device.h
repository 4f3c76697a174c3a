// The Vulkan device: choosing it, creating it, and memory on it. Everything below src/gpu is the only code
// that calls Vulkan; other folders see Device, Buffer, Image and FrameGraph.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::gpu {

/// The device does nothing any more: its driver has crashed, or has been reset. All that was made on it is
/// gone; a new Device may work.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

/// Memory of the device, or of the host for it, has run out.
class OutOfMemory : public Error {
  public:
    using Error::Error;
};

/// No device fits, or the device lacks what is needed.
class Unsupported : public Error {
  public:
    using Error::Error;
};

/// What `limpid info` lists of a physical device.
/// In the order in which a device is chosen.
enum class DeviceType { Discrete, Integrated, Virtual, Other, Cpu };
/// "discrete", "integrated", "virtual", "other", "cpu".
std::string_view nameOf(DeviceType type);

struct DeviceInfo {
    uint32_t index = 0;
    std::string name;
    DeviceType type = DeviceType::Other;
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
    bool readsEnvironment = true;  ///< LIMPID_VALIDATION counts
    /// Gets the validation layer's messages. None: they are only counted.
    MessageCallback messages;
};

struct AdoptedDevice;  ///< gpu/vulkan/adopted_device.h

/// All Vulkan devices of this machine; empty if there is no Vulkan loader or driver.
std::vector<DeviceInfo> enumerateDevices();

class Device {
  public:
    explicit Device(const DeviceOptions& options = {});
    /// On a device of the caller's, which outlives this one. Frames are recorded into his command buffers
    /// (FrameGraph::record()); execute() and what copies to and from the host throw Error. Throws Error
    /// naming the features that the device lacks.
    explicit Device(const AdoptedDevice& adopted);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const;
    bool isCpu() const { return info().type == DeviceType::Cpu; }
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

    /// Pipelines belong to the device: all graphs that run on it share them. What the driver has compiled so
    /// far, to be kept by the caller and given to loadPipelineCache() in the next run of the program, on the
    /// same driver.
    std::vector<std::byte> pipelineCacheData() const;
    /// To be called before any pipeline is made, else it throws Error. Data that are damaged, or of another
    /// device or driver, are ignored.
    void loadPipelineCache(std::span<const std::byte> data);
    /// So far.
    size_t pipelineCount() const;

    struct Impl;
    Impl& impl() { return *impl_; }

  private:
    std::unique_ptr<Impl> impl_;
};

/// What to keep images in that filters read many times over: buffers are faster on GPUs, images on CPUs
/// (docs/benchmarks.md).
Backing filterBacking(const Device& device);

}  // namespace limpid::gpu
