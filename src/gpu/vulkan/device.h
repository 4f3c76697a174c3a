// The Vulkan device: selects it, creates it, and allocates memory on it. Only code below src/gpu calls
// Vulkan; other folders use Device, Buffer, Image and FrameGraph.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::gpu {

/// The device no longer works: its driver crashed or was reset. Everything created on it is lost; a new
/// Device may work.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

/// Memory of the device, or host memory for it, has run out.
class OutOfMemory : public Error {
  public:
    using Error::Error;
};

/// No device is suitable, or the device lacks a required feature.
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
    uint64_t memoryBytes = 0;  ///< size of the largest device-local heap
    bool usable = false;
    bool rayTracing = false;  ///< supports ray-tracing pipelines and acceleration structures
    /// True if it appears to have ray-tracing hardware: some drivers emulate ray tracing on shader cores.
    bool rayTracingCores = false;
    /// VK_NV_cooperative_matrix: a subgroup of 32 threads can multiply 16x16 matrices of halves and
    /// accumulate in single precision.
    bool cooperativeMatrices = false;
    std::string whyNot;                                    ///< if not usable: the missing features
    std::vector<std::pair<std::string, bool>> features;    ///< required and optional, by Vulkan name
    std::vector<std::pair<std::string, uint64_t>> limits;  ///< those that Limpid checks, by Vulkan name
};

/// Ids and values, sorted.
using SpecialisationConstants = std::vector<std::pair<uint32_t, uint32_t>>;

/// Returns the SPIR-V of a shader in which the constants have these values, or nothing if it cannot.
using Specialise =
    std::function<std::vector<uint32_t>(std::span<const uint32_t>, const SpecialisationConstants&)>;

struct DeviceOptions {
    /// "" selects the best usable device (discrete before integrated before cpu); "cpu" a software device; a
    /// number the device with that index; anything else the first device whose name contains it, ignoring
    /// case.
    std::string select;
    /// Enables the Khronos validation layer with synchronisation validation. Every message is logged and
    /// counted. The environment variable LIMPID_VALIDATION=1 enables it too. Throws Error if it is requested
    /// but not installed.
    bool validation = false;
    /// Instance extensions that the window system requires (glfwGetRequiredInstanceExtensions) for presenting
    /// pictures in windows (gpu/present/presenter.h). Missing extensions are skipped; then the device cannot
    /// present. With them, VK_EXT_swapchain_colorspace is enabled where there is one.
    std::vector<std::string> surfaceExtensions;
    bool readsEnvironment = true;  ///< LIMPID_VALIDATION is respected
    /// Receives the validation layer's messages. None: they are only counted.
    MessageCallback messages;
    /// Sets specialisation constants before a CPU's driver sees a shader (gpu/specialise/specialise.h).
    /// Called from several threads at once. None: the driver does it, as on GPUs.
    Specialise specialise;
    /// Where there are so many pipelines, a new one takes the place of the oldest that the last 1,024
    /// dispatches have not used. On lavapipe, each takes 0.5 MB or more.
    size_t mostPipelines = 128;
};

struct AdoptedDevice;  ///< in gpu/vulkan/adopted_device.h

/// Lists all Vulkan devices of this machine; empty if there is no Vulkan loader or driver.
std::vector<DeviceInfo> enumerateDevices();

class Device {
  public:
    explicit Device(const DeviceOptions& options = {});
    /// Uses the device of the caller, which must outlive this one. FrameGraph::record() writes frames into
    /// command buffers of the caller; execute(), uploads and downloads throw Error, since they would submit.
    /// Throws Error naming missing features of the device.
    explicit Device(const AdoptedDevice& adopted);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const;
    bool isCpu() const { return info().type == DeviceType::Cpu; }
    /// Messages of the validation layer so far (warnings and errors, not performance advice). Tests want 0.
    uint64_t validationMessages() const;
    /// Device memory currently allocated, including staging buffers.
    uint64_t allocatedBytes() const;
    uint32_t maxImageSide() const;  ///< maxImageDimension2D
    uint64_t maxTexelBufferElements() const;
    uint64_t maxAllocationBytes() const;     ///< maxMemoryAllocationSize
    uint64_t maxBufferBytes() const;         ///< the smaller of maxBufferSize and maxMemoryAllocationSize
    uint64_t maxStorageBufferBytes() const;  ///< the same, and at most maxStorageBufferRange

    /// Creates a device-local storage texel buffer containing `data` (at least one texel; empty data gives
    /// one zero texel). Throws Error naming the limit if the data exceeds maxTexelBufferElements or the
    /// device's allocation limits.
    Buffer createTexelBuffer(const std::string& name, Format format, std::span<const std::byte> data);
    /// Creates a device-local storage buffer of `bytes` zero bytes, or one containing `data`.
    Buffer createStorageBuffer(const std::string& name, uint64_t bytes);
    Buffer createStorageBuffer(const std::string& name, std::span<const std::byte> data);
    /// Copies the whole buffer to the host; waits for the device.
    std::vector<std::byte> download(const Buffer& buffer);

    void waitIdle();

    /// Returns the driver's compiled pipelines. Save them and pass them to loadPipelineCache() in the next
    /// run of the program with the same driver. Pipelines belong to the device and are shared by all graphs
    /// on it.
    std::vector<std::byte> pipelineCacheData() const;
    /// Call it before any pipeline is created, else it throws Error. Data that is damaged, or from another
    /// device or driver, is ignored.
    void loadPipelineCache(std::span<const std::byte> data);
    /// Number of pipelines created so far.
    size_t pipelineCount() const;
    /// Number of those that exist: see DeviceOptions::mostPipelines.
    size_t keptPipelineCount() const;
    /// Calls `listener` whenever a frame needs pipelines that do not exist yet, in the thread that executes
    /// or prepares the frame, before they are created. That can take seconds if the driver has to compile
    /// shaders; lavapipe compiles them later, while it computes the frame. Not thread-safe; call it between
    /// frames. An empty function ends it.
    void onNewPipelines(std::function<void()> listener);

    struct Impl;
    Impl& impl() { return *impl_; }

  private:
    std::unique_ptr<Impl> impl_;
};

/// Returns what is best on the device: buffers on GPUs, images on CPUs (docs/benchmarks.md); matrices where
/// it has them.
FilterChoice filterChoice(const Device& device);

}  // namespace limpid::gpu
