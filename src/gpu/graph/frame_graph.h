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

#include "gpu/graph/resources.h"
#include "gpu/graph/shader.h"

struct VkCommandBuffer_T;

namespace limpid::gpu {

struct Extent {
    uint32_t width = 0;
    uint32_t height = 0;
    bool operator==(const Extent&) const = default;
};

/// Valid from its creation until the next beginFrame(); a later use throws Error. The upper bits of `index`
/// are the frame's number (modulo), so do not use it as an index.
struct ImageHandle {
    uint32_t index = UINT32_MAX;
    explicit operator bool() const { return index != UINT32_MAX; }
    bool operator==(const ImageHandle&) const = default;
};

/// What holds an image's pixels. A shader declares the one as an image, the other as an array of texels, row
/// 0 first, in a storage buffer; on some GPUs filters read buffers twice as fast, on CPUs images are faster.
enum class Backing { Image, Buffer };

struct Image;  ///< gpu/vulkan/memory/image.h, for gpu/ only

/// An image of somebody else's, as Vulkan describes it (the values are Vulkan's own). It has one layer and
/// one level in `view`. What it is bound to decides how it is used: sampled, it stays in its layout, which
/// must be one that shaders may read in; as a storage image it is in GENERAL while the frame runs.
struct ForeignImage {
    uint64_t image = 0;         ///< VkImage
    uint64_t view = 0;          ///< VkImageView
    uint32_t aspects = 1;       ///< VkImageAspectFlags of the view; 1: colour
    uint32_t layoutBefore = 0;  ///< VkImageLayout in which the frame finds it; 0 (UNDEFINED): content is lost
    uint32_t layoutAfter = 0;   ///< ... and in which it leaves it; of sampled images layoutBefore
    uint64_t stagesBefore = 0;  ///< VkPipelineStageFlags2 and VkAccessFlags2 that the frame waits for
    uint64_t accessBefore = 0;
    uint64_t stagesAfter = 0;  ///< ... and that wait for the frame
    uint64_t accessAfter = 0;
};

/// An image pair that lives from frame to frame.
struct History {
    ImageHandle previous;  ///< what `current` was in the last frame that recorded this history
    ImageHandle current;
    bool valid = false;  ///< false on the first frame, after resize, a change of format, and resetHistories()
};

struct Binding {
    std::string_view name;  ///< the GLSL variable's (for a buffer block: the instance's) name
    std::variant<ImageHandle, const Buffer*, const AccelerationStructures*> resource;
};

/// The parameter struct of a dispatch, by value; it must have exactly the size of the shader's uniform block.
/// Struct members match on both sides through scalar block layout.
template <typename T>
std::span<const std::byte> paramsOf(const T& params) {
    return std::as_bytes(std::span<const T, 1>(&params, 1));
}

/// A specialisation constant's value, by the constant's GLSL name. Bools are 0 and 1.
struct ConstantValue {
    std::string_view name;
    uint32_t value = 0;
};

/// What the rays of a ray-generation shader run. Several may share code; all see the same bindings and
/// constants.
struct RayShaders {
    const ShaderCode& miss;
    const ShaderCode& closestHit;
    const ShaderCode& anyHit;
};

/// What `shader` and `rays` view is static, as in embedded shaders: pipelines keep it.
struct Dispatch {
    std::string_view pass;     ///< "technique/step": shown by the profiler and named on the command line
    const ShaderCode& shader;  ///< compute; ray generation if `rays` is set
    std::vector<Binding> bindings;
    std::span<const std::byte> params;  ///< copied at once
    std::vector<ConstantValue> constants;
    Extent extent;  ///< threads; the group count follows from the shader's workgroup size
    const RayShaders* rays = nullptr;
};

/// A pass that the host computes, on devices whose memory it sees: CPUs. All images have Backing::Buffer.
struct HostPass {
    std::string_view pass;
    std::vector<ImageHandle> reads, writes;
    /// Gets the pixels of `reads`, then those of `writes`, row 0 first.
    std::function<void(std::span<const std::span<std::byte>> pixels)> run;
};

/// Why a pass waits: for tests, and for whoever reads a frame.
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
    /// Of the images it reads plus those it writes, each once: the least that it can move.
    uint64_t imageBytes = 0;
};

struct PassTime {
    std::string name;
    double milliseconds = 0.0;
};

struct GraphOptions {
    /// Of frames that are under way on the device at once. execute() waits for the frame that so many frames
    /// ago was executed; record() relies on the caller for that. 1 to 8.
    uint32_t framesInFlight = 2;
    /// Before the names of images and passes, for debuggers: "a/" tells this graph's from others'.
    std::string prefix;
    bool timestamps = true;  ///< passTimes() tells something
};

class FrameGraph {
  public:
    explicit FrameGraph(GraphOptions options = {});
    ~FrameGraph();
    FrameGraph(const FrameGraph&) = delete;
    FrameGraph& operator=(const FrameGraph&) = delete;

    /// Starts a new frame; the handles of the last one are void.
    void beginFrame();

    /// An image for this frame; its content is undefined until a pass writes it. Names are unique within a
    /// frame.
    ImageHandle transient(const std::string& name, Format format, Extent extent,
                          Backing backing = Backing::Image);
    /// A pair that lives across frames. One call per frame and name. Not recording it in a frame drops it.
    /// `previous` can only be read; while the history is invalid it is zero. The history is valid in the next
    /// frame if this frame writes `current` and is executed.
    History history(const std::string& name, Format format, Extent extent, Backing backing = Backing::Image);
    /// An image of the caller's. It counts as written. `format`: bound as a storage image, what the shader
    /// declares; sampled, RGBA32Float for components that are read as floats and RGBA32Uint for unsigned
    /// ones.
    ImageHandle import(const std::string& name, Format format, Extent extent, const ForeignImage& foreign);

    /// From the next frame on, every history starts anew (scene cut, changed settings).
    void resetHistories();

    /// From the next dispatch on, these stand for the shaders of their names. They must outlive their use,
    /// may change between frames, and must have the interfaces (sameInterface()) of those that they replace.
    void setReplacements(const ShaderReplacements* replacements);
    /// All stages of the shaders of all frames so far, as they were last used; valid until another dispatch
    /// is recorded.
    std::vector<ShaderCode> usedShaders() const;

    Extent extent(ImageHandle image) const;
    Format format(ImageHandle image) const;
    const std::string& name(ImageHandle image) const;

    /// Records a pass. Throws Error naming pass and variable if a binding is missing, extra, of the wrong
    /// kind or format, or read though nothing wrote it; if one resource is bound twice and one of the two can
    /// write; if the parameter struct's size is not the uniform block's; if a constant is unknown; if the
    /// extent is empty. Every variable that the shader declares must be bound, used or not; the uniform block
    /// is filled from params. A recorded Buffer may be destroyed: the frame keeps what it needs.
    void dispatch(const Dispatch& dispatch);

    /// Records a pass of the host's: execute() waits there until the passes before it are done, and runs it.
    /// Throws Error if an image is not in a buffer, or is read though nothing wrote it; execute() does if the
    /// host cannot see the device's memory.
    void host(HostPass pass);

    /// Writes `data` into the buffer, from byte `offset` on, before the first pass of this frame; after all
    /// passes of earlier frames. Both are multiples of 4 bytes; ranges of one frame must not overlap. Throws
    /// Error if the data reaches beyond the buffer.
    void upload(const Buffer& buffer, uint64_t offset, std::span<const std::byte> data);

    /// Gives a transient image, which nothing has written yet, its pixels: all components, row 0 first.
    /// Throws Error if `pixels` has another size than the image.
    void upload(ImageHandle image, std::span<const std::byte> pixels);

    /// Puts a tree elsewhere, for the next rebuild(); as an upload().
    void place(const AccelerationStructures& structures, uint32_t placement, const TreePlacement& where);
    /// A pass that fits the trees that move to their triangles and builds the top level anew.
    void rebuild(std::string_view pass, const AccelerationStructures& structures);

    /// What has been recorded since beginFrame().
    const std::vector<RecordedPass>& passes() const;
    /// Device memory of the images that these passes write, those of passes() from `first` on: each image
    /// once, and a history as the pair that it is.
    uint64_t bytesOfImagesWrittenFrom(size_t first) const;
    /// Images that the pass writes, for --dump. Empty if there is no such pass.
    std::vector<ImageHandle> imagesWrittenBy(std::string_view pass) const;
    /// The previous images of histories that the pass reads, for --dump too.
    std::vector<ImageHandle> previousReadBy(std::string_view pass) const;

    /// Submits the recorded frame. Returns at once; at most `framesInFlight` frames are under way. Once per
    /// frame, and always on the same device.
    void execute(Device& device);
    /// The same, into a command buffer of the caller's, outside of a render pass; he submits it to a queue
    /// that computes. What the frame waits for, and what may run after it:
    /// gpu/vulkan/execute/frame_executor.h. He sees to it that the frame recorded `framesInFlight` calls ago
    /// is done. Throws Error if a pass runs on the host.
    void record(Device& device, VkCommandBuffer_T* commands);
    /// Makes the pipelines of what has been recorded and are not there yet, on several threads. Executes
    /// nothing.
    void prepare(Device& device);
    /// Device memory of the images that this frame needs, histories as the pairs that they are, imported ones
    /// left out.
    uint64_t imageBytes() const;
    /// As if execute() had run: lets tests follow histories over frames without a device.
    void assumeExecuted();
    /// The pixels of an image of the last executed frame, all components, row 0 first. Waits for the device.
    std::vector<float> downloadFloat(Device& device, ImageHandle image);
    std::vector<uint32_t> downloadUint(Device& device, ImageHandle image);
    /// The image behind a handle of the last executed frame: for this folder.
    const Image& imageOnDevice(Device& device, ImageHandle image);
    /// Time per pass, of the latest frame that is finished on the device (waits for the last one submitted).
    std::vector<PassTime> passTimes(Device& device);

    struct Impl;

  private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::gpu
