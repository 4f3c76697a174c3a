// The inside of FrameGraph: what recording leaves for execution. No Vulkan call is made here.
#pragma once

#include <map>
#include <set>

#include "gpu/graph/frame_graph.h"

namespace limpid::gpu {

class FrameExecutor;

/// A compute shader, or the shaders of a ray-tracing pipeline with ray generation first, and what they
/// declare together; kept as long as a frame or a pipeline uses it.
struct Shader {
    uint64_t hash = 0;  ///< of all stages; equal: the same shader
    using Stage = ShaderCode;
    std::string name;  ///< of the first stage
    std::vector<Stage> stages;
    ShaderReflection reflection;
    MergedDeclarations merged;                              ///< of several stages: what `reflection` views
    std::vector<std::shared_ptr<const ShaderCode>> owners;  ///< of replacements: what they view

    bool tracesRays() const { return reflection.stage == ShaderStage::RayGeneration; }
};

/// Which device image a recorded image is. `half` tells the two of a history pair apart.
struct ImageKey {
    std::string name;
    uint32_t half = 0;
    Format format{};
    uint32_t width = 0, height = 0;
    Backing backing = Backing::Image;
    auto operator<=>(const ImageKey&) const = default;
};

struct RecordedImage {
    enum class Role { Transient, Previous, Current, Foreign };
    std::string name;
    ImageKey key;
    Role role{};
    ForeignImage foreign;  ///< of role Foreign
    bool clear = false;    ///< zeroed before the first pass: of a history that is not valid
    bool written = false;
    /// Of role Foreign: some pass samples it, or binds it as a storage image. It cannot be in both layouts.
    bool sampled = false, stored = false;

    Extent extent() const { return {key.width, key.height}; }
    uint64_t bytes() const { return uint64_t{key.width} * key.height * bytesPerTexel(key.format); }
};

struct BoundResource {
    uint32_t binding = 0;
    BindingKind kind{};
    uint32_t image = 0;  ///< index of images
    /// Of buffers; of acceleration structures where the top level lies.
    std::shared_ptr<const BufferResource> buffer;
    std::shared_ptr<const StructuresResource> structures;
};

struct RecordedDispatch {
    std::shared_ptr<const Shader>
        shader;  ///< none: rebuilds the acceleration structures of its only resource
    std::vector<BoundResource> resources;
    uint32_t paramsBinding = 0;
    size_t paramsOffset = 0, paramsSize = 0;  ///< in RecordedFrame::params; size 0: no uniform block
    std::vector<std::pair<uint32_t, uint32_t>> constants;  ///< id and value, sorted
    std::array<uint32_t, 3> groups{};
    std::array<uint32_t, 3> workgroupSize{};
    std::function<void(std::span<const std::span<std::byte>>)>
        host;                          ///< instead of all this: a pass of the host's
    std::vector<uint32_t> hostImages;  ///< indices of images, in its order
};

/// Data that reaches a buffer or an image before the first pass.
struct RecordedUpload {
    std::shared_ptr<const BufferResource> buffer;  ///< none: an image
    uint64_t offset = 0;                           ///< in the buffer
    uint32_t image = 0;                            ///< index of images
    size_t at = 0, size = 0;                       ///< in RecordedFrame::uploadData
};

/// Everything that one frame says.
struct RecordedFrame {
    uint64_t number = 0;
    std::vector<RecordedUpload> uploads;
    std::vector<std::byte> uploadData;
    std::vector<RecordedImage> images;
    std::vector<RecordedPass> passes;
    std::vector<RecordedDispatch> dispatches;  ///< one per pass
    std::vector<std::byte> params;
    bool executed = false;
};

/// Who touched a resource last, as far as later passes may have to wait for it.
struct ResourceUse {
    static constexpr size_t none = SIZE_MAX;
    size_t lastWriter = none;
    std::vector<size_t> readers;  ///< since the last write
};

/// One resource of a pass.
struct Access {
    const BufferResource* buffer = nullptr;  ///< of buffers
    uint32_t image = 0;                      ///< index of images
    std::string name;
    bool reads = false, writes = false;
};

/// A history between frames.
struct HistoryState {
    Format format{};
    Extent extent;
    Backing backing = Backing::Image;
    uint32_t currentHalf = 0;  ///< which half the last executed frame wrote
    bool valid = false;
};

struct FrameGraph::Impl {
    GraphOptions options;
    RecordedFrame frame;
    std::set<std::string, std::less<>> names;  ///< of this frame's images
    std::map<std::string, HistoryState> histories;
    std::map<std::string, uint32_t> recordedHistories;  ///< of this frame, with the index of `current`
    bool resetRequested = false;
    std::map<std::string, std::shared_ptr<const Shader>, std::less<>> shaders;
    const ShaderReplacements* replacements = nullptr;
    std::vector<ResourceUse> imageUses;
    std::map<const BufferResource*, ResourceUse> bufferUses;
    size_t lastBarrier = 0;                   ///< the last pass that waits: all before it are done by then
    std::shared_ptr<FrameExecutor> executor;  ///< none in recording alone; only gpu/vulkan looks inside

    explicit Impl(GraphOptions options);
    ~Impl();

    void requireRecording() const;
    ResourceUse& useOf(const Access& access);
    void commitHistories();
    ImageHandle addImage(RecordedImage image);
    void claimName(const std::string& name);
    /// Index of a handle of this frame; throws Error if it is empty or of another frame.
    uint32_t indexOf(ImageHandle handle) const;
    std::shared_ptr<const Shader> shaderOf(const ShaderCode& code, const RayShaders* rays);
    /// What replaces the code, or else, without an owner, the code itself.
    std::shared_ptr<const ShaderCode> replaced(const ShaderCode& code) const;
    /// Finds what the pass, which comes next, has to wait for; then notes what it touches.
    void noteAccesses(RecordedPass& pass, std::span<const Access> accesses);
    FrameExecutor& executorFor(Device& device);
    /// For what runs the frame: checks that everything it uses lies on `device`.
    FrameExecutor& readyToRun(Device& device);
    /// For downloads and times: throws Error unless a frame was executed on `device`.
    FrameExecutor& executed(Device& device) const;
};

}  // namespace limpid::gpu
