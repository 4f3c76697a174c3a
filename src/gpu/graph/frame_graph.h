// The frame graph: what a frame does, rebuilt each frame by plain function calls.
//
// A technique is a function that takes the graph and image handles and returns image handles:
//
//     ImageHandle tonemap(FrameGraph& graph, ImageHandle color, const TonemapParams& params) {
//         const ImageHandle out = graph.transient("tonemap", Format::RGBA8Unorm, graph.extent(color));
//         graph.dispatch({.pass = "tonemap",
//                         .shader = shaders::tonemap_comp,
//                         .bindings = {{"color", color}, {"result", out}},
//                         .params = paramsOf(params),
//                         .extent = graph.extent(color)});
//         return out;
//     }
//
// Recording checks every dispatch against the shader's reflection and needs no device; execute() needs one.
// Execution is in recording order, images stay in GENERAL layout, and a pass that touches what an earlier one
// wrote, or writes what an earlier one still reads, waits for it. Access follows from the GLSL qualifiers:
// `readonly` reads, `writeonly` writes, neither does both.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.h"
#include "gpu/graph/resources.h"
#include "gpu/graph/shader.h"

struct VkCommandBuffer_T;

namespace limpid::gpu {

struct Extent {
    uint32_t width = 0;
    uint32_t height = 0;
    bool operator==(const Extent&) const = default;
};

/// Valid from its creation until the next beginFrame(); later use throws Error. The upper bits of `index`
/// hold the frame's number (modulo), so do not use it as an index.
struct ImageHandle {
    uint32_t index = UINT32_MAX;
    explicit operator bool() const { return index != UINT32_MAX; }
    bool operator==(const ImageHandle&) const = default;
};

/// Where an image's pixels are stored. A shader declares an Image as an image, and a Buffer as an array of
/// texels in a storage buffer, row 0 first. On some GPUs filters read buffers twice as fast; on CPUs images
/// are faster.
enum class Backing { Image, Buffer };

/// What filters choose by the device.
struct FilterChoice {
    Backing backing = Backing::Image;     ///< of images that they read many times
    bool matrices = false;                ///< cooperative matrices (DeviceInfo::cooperativeMatrices)
    uint64_t largestBuffer = UINT64_MAX;  ///< bytes; methods divide pictures whose buffers would be larger
    bool cpu = false;                     ///< the device is the CPU, which sees all its memory
};

struct Image;  ///< defined in gpu/vulkan/memory/image.h, for gpu/ only

/// An image that the caller owns, with the values that Vulkan uses. `view` has one layer and one level. How
/// it is bound decides how it is used: a sampled image stays in its layout, which must be one that shaders
/// can read; a storage image is in GENERAL while the frame runs.
struct ForeignImage {
    uint64_t image = 0;         ///< VkImage
    uint64_t view = 0;          ///< VkImageView
    uint32_t aspects = 1;       ///< VkImageAspectFlags of the view; 1: colour
    uint32_t layoutBefore = 0;  ///< VkImageLayout before the frame; 0 (UNDEFINED): the content is lost
    uint32_t layoutAfter = 0;   ///< VkImageLayout after the frame; for sampled images equal to layoutBefore
    uint64_t stagesBefore = 0;  ///< VkPipelineStageFlags2 and VkAccessFlags2 that the frame waits for
    uint64_t accessBefore = 0;
    uint64_t stagesAfter = 0;  ///< those that wait for the frame
    uint64_t accessAfter = 0;
};

/// A pair of images that persists between frames.
struct History {
    ImageHandle previous;  ///< content of `current` in the last frame that recorded this history
    ImageHandle current;
    bool valid = false;  ///< false in the first frame, and after a resize, a change of format, or
                         ///< resetHistories()
};

struct Binding {
    std::string_view name;  ///< name of the GLSL variable (for a buffer block: of the instance)
    std::variant<ImageHandle, const Buffer*, const AccelerationStructures*> resource;
};

/// Converts the parameter struct of a dispatch. It must have exactly the size of the shader's uniform block.
/// Scalar block layout makes the members match on both sides.
template <typename T>
std::span<const std::byte> paramsOf(const T& params) {
    return std::as_bytes(std::span<const T, 1>(&params, 1));
}

/// The value of a specialisation constant, identified by its GLSL name. Bools are 0 and 1.
struct ConstantValue {
    std::string_view name;
    uint32_t value = 0;
};

/// The shaders that rays of a ray-generation shader run. Several may share code; all see the same bindings
/// and constants.
struct RayShaders {
    const ShaderCode& miss;
    const ShaderCode& closestHit;
    const ShaderCode& anyHit;
};

/// The data behind `shader` and `rays` must be static, like embedded shaders: pipelines keep it.
struct Dispatch {
    std::string_view pass;     ///< "technique/step": shown by the profiler and used on the command line
    const ShaderCode& shader;  ///< compute; ray generation if `rays` is set
    std::vector<Binding> bindings;
    std::span<const std::byte> params;  ///< copied immediately
    std::vector<ConstantValue> constants;
    Extent extent;  ///< threads; the group count is derived from the shader's workgroup size
    const RayShaders* rays = nullptr;
};

/// A pass that runs on the CPU, for devices whose memory the CPU sees. All images have Backing::Buffer.
struct HostPass {
    std::string_view pass;
    std::vector<ImageHandle> reads, writes;
    /// Called with the pixels of `reads`, then those of `writes`, row 0 first.
    std::function<void(std::span<const std::span<std::byte>> pixels)> run;
};

/// The reason why a pass waits, for tests and for inspecting a frame.
struct Hazard {
    enum class Kind { ReadAfterWrite, WriteAfterWrite, WriteAfterRead };
    Kind kind{};
    std::string resource;
    std::string earlierPass;
};

struct RecordedPass {
    std::string name;
    std::string shader;
    std::vector<std::string> reads, writes;  ///< resource names
    std::vector<Hazard> hazards;             ///< empty: runs without a barrier
    std::array<uint32_t, 3> groups{};
    /// Bytes of the images that the pass reads or writes, each counted once: the least that it can move.
    uint64_t imageBytes = 0;
};

struct PassTime {
    std::string name;
    double milliseconds = 0.0;
};

struct GraphOptions {
    /// The number of frames that may be on the device at once, 1 to 8. execute() waits for the frame this
    /// many frames ago; with record(), the caller must ensure that it is finished.
    uint32_t framesInFlight = 2;
    /// Prefix of image and pass names in debuggers, such as "a/", to tell graphs apart.
    std::string prefix;
    bool timestamps = true;  ///< enables passTimes()
    /// Lets images share memory within a frame: a transient image may take that of another transient image,
    /// or of a history's previous one, of the same extent, backing and format (in buffers, size of a texel),
    /// that no pass from its first write on accesses. An image whose last access is a write is a result and
    /// keeps its memory. Others can then not be downloaded. A history takes the memory of one image, not two,
    /// if the previous one is last read before the current one is first accessed.
    bool shareMemory = false;
};

/// Thrown by FrameGraph::execute() where its caller interrupted it.
class Interrupted : public Error {
  public:
    Interrupted() : Error("the frame was interrupted") {}
};

class FrameGraph {
  public:
    explicit FrameGraph(GraphOptions options = {});
    ~FrameGraph();
    FrameGraph(const FrameGraph&) = delete;
    FrameGraph& operator=(const FrameGraph&) = delete;

    /// Starts a new frame; handles of the previous one become invalid.
    void beginFrame();

    /// Creates an image for this frame; its content is undefined until a pass writes it. Names must be unique
    /// within a frame.
    ImageHandle transient(const std::string& name, Format format, Extent extent,
                          Backing backing = Backing::Image);
    /// Creates a pair of images that persists between frames. Call it once per frame and name; a history that
    /// is not recorded in a frame is dropped. `previous` is read-only, and zero while the history is invalid.
    /// The history is valid in the next frame if this frame writes `current` and is executed.
    History history(const std::string& name, Format format, Extent extent, Backing backing = Backing::Image);
    /// Uses an image of the caller's, which counts as written. `format`: for a storage image, the format that
    /// the shader declares; for a sampled image, RGBA32Float if components are read as floats and RGBA32Uint
    /// if as unsigned integers.
    ImageHandle import(const std::string& name, Format format, Extent extent, const ForeignImage& foreign);

    /// Invalidates every history from the next frame on (scene cut, changed settings).
    void resetHistories();

    /// Makes execute() interruptible on CPUs, whose frames can take seconds: it cuts the frame into short
    /// submissions that it waits for, asks `interrupted` between them and after passes on the host, on its
    /// own thread, and throws Interrupted if that returns true. Histories are undefined then: use another
    /// graph. None (the default): frames run as a whole. Other devices ignore it.
    void setInterruption(std::function<bool()> interrupted);

    /// From the next dispatch on, replaces shaders by those of the same name. They must outlive their use,
    /// may change between frames, and must have the same interface (sameInterface()) as the originals.
    void setReplacements(const ShaderReplacements* replacements);
    /// Returns all stages of the shaders used in all frames so far, in the version last used; valid until
    /// another dispatch is recorded.
    std::vector<ShaderCode> usedShaders() const;

    Extent extent(ImageHandle image) const;
    Format format(ImageHandle image) const;
    Backing backing(ImageHandle image) const;
    const std::string& name(ImageHandle image) const;

    /// Records a pass. Throws Error naming pass and variable if a binding is missing, extra, of the wrong
    /// kind or format, or read although nothing wrote it; if a resource is bound twice and one of the two can
    /// write; if the parameter struct and the uniform block differ in size; if a constant is unknown; or if
    /// the extent is empty. Every variable that the shader declares must be bound, used or not; the uniform
    /// block is filled from `params`. A recorded Buffer may be destroyed: the frame keeps what it needs.
    void dispatch(const Dispatch& dispatch);

    /// Records a pass that runs on the CPU: execute() waits for the passes before it, then runs it. Throws
    /// Error if an image is not in a buffer, or is read although nothing wrote it; execute() throws if the
    /// CPU cannot see the device's memory.
    void host(HostPass pass);

    /// Writes `data` into the buffer at byte `offset`, after all passes of earlier frames and before the
    /// first pass of this one. Offset and size must be multiples of 4 bytes; ranges of one frame must not
    /// overlap. Throws Error if the data does not fit in the buffer.
    void upload(const Buffer& buffer, uint64_t offset, std::span<const std::byte> data);

    /// Sets all pixels of a transient image that nothing has written yet: all components, row 0 first. Throws
    /// Error if `pixels` does not have the size of the image.
    void upload(ImageHandle image, std::span<const std::byte> pixels);

    /// The same without copies of all of them in host memory: `pixels` must stay as they are until execute()
    /// or record() has returned, and execute() waits for copies to the device.
    void uploadBorrowed(ImageHandle image, std::span<const std::byte> pixels);

    /// Moves a tree at the next rebuild(); timed like an upload().
    void place(const AccelerationStructures& structures, uint32_t placement, const TreePlacement& where);
    /// Records a pass that refits the moving trees to their triangles and rebuilds the top level.
    void rebuild(std::string_view pass, const AccelerationStructures& structures);

    /// The passes recorded since beginFrame().
    const std::vector<RecordedPass>& passes() const;
    /// Returns the device memory of the images written by passes() from index `first` on. Each image counts
    /// once, a history with its past, and images that share memory as one.
    uint64_t bytesOfImagesWrittenFrom(size_t first) const;
    /// Returns the images that the pass writes, for --dump. Empty if there is no such pass.
    std::vector<ImageHandle> imagesWrittenBy(std::string_view pass) const;
    /// Returns the previous images of histories that the pass reads, for --dump.
    std::vector<ImageHandle> previousReadBy(std::string_view pass) const;

    /// Submits the recorded frame and returns without waiting for it; at most `framesInFlight` frames are in
    /// flight. Call it once per frame, always with the same device.
    void execute(Device& device);
    /// Records the frame into a command buffer of the caller's instead, outside of a render pass, to be
    /// submitted to a compute-capable queue. See gpu/vulkan/execute/frame_executor.h for its synchronisation.
    /// The caller must ensure that the frame recorded `framesInFlight` calls ago is finished. Throws Error if
    /// a pass runs on the CPU.
    void record(Device& device, VkCommandBuffer_T* commands);
    /// Creates the images of the recorded frame that no frame has used yet, and records their clearing, so
    /// that the first frame does not wait for memory. Executes no pass; imported images are not touched.
    void clearImages(Device& device, VkCommandBuffer_T* commands);
    /// Compiles the missing pipelines of all recorded passes, on several threads. Executes nothing.
    void prepare(Device& device);
    /// Whether all of them are there.
    bool isPrepared(Device& device) const;
    /// As prepare(), but beside a thread that executes other graphs on the device: does not call
    /// Device::onNewPipelines(). Its threads have the priority of the caller's.
    void prepareBeside(Device& device);
    /// Returns the device memory of the images that this frame needs. Histories count as pairs, images that
    /// share memory as one; imported images do not count.
    uint64_t imageBytes() const;
    /// Returns the bytes of the largest of these images with Backing::Buffer; 0 if there is none.
    uint64_t largestBufferBytes() const;
    /// Behaves as if execute() had run: lets tests follow histories over frames without a device.
    void assumeExecuted();
    /// Returns the pixels of an image of the last executed frame, all components, row 0 first. Waits for the
    /// device.
    std::vector<float> downloadFloat(Device& device, ImageHandle image);
    /// The same for unsigned integers, and for RGBA8Unorm: a whole pixel each, red in the lowest byte.
    std::vector<uint32_t> downloadUint(Device& device, ImageHandle image);
    /// Returns the image behind a handle of the last executed frame. Only for code in src/gpu.
    const Image& imageOnDevice(Device& device, ImageHandle image);
    /// The same; throws Error if the image cannot be downloaded, because no pass wrote it or its memory was
    /// reused.
    const Image& downloadable(Device& device, ImageHandle image);
    /// Returns the time per pass of the latest finished frame (waits for the last one submitted).
    std::vector<PassTime> passTimes(Device& device);

    struct Impl;

  private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::gpu
