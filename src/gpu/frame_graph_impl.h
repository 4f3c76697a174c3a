// The inside of FrameGraph: what recording leaves for execution. No Vulkan call is made here.
#pragma once

#include <map>
#include <set>

#include "gpu/buffer.h"
#include "gpu/frame_graph.h"

namespace limpid::gpu {

class FrameExecutor;

/// A shader and its reflection, kept as long as a frame or a pipeline uses it.
struct Shader {
    std::string name;
    std::vector<uint32_t> words;
    ShaderReflection reflection;
};

/// Which device image a recorded image is. `half` tells the two of a history pair apart.
struct ImageKey {
    std::string name;
    uint32_t half = 0;
    Format format{};
    uint32_t width = 0, height = 0;
    auto operator<=>(const ImageKey&) const = default;
};

struct RecordedImage {
    enum class Role { Transient, Previous, Current };
    std::string name;
    ImageKey key;
    Role role{};
    bool clear = false;  ///< zeroed before the first pass: of a history that is not valid
    bool written = false;

    Extent extent() const { return {key.width, key.height}; }
};

struct BoundResource {
    uint32_t binding = 0;
    BindingKind kind{};
    uint32_t image = 0;                           ///< index of images
    std::shared_ptr<const BufferStorage> buffer;  ///< of buffers
};

struct RecordedDispatch {
    std::shared_ptr<const Shader> shader;
    std::vector<BoundResource> resources;
    uint32_t paramsBinding = 0;
    size_t paramsOffset = 0, paramsSize = 0;  ///< in RecordedFrame::params; size 0: no uniform block
    std::vector<std::pair<uint32_t, uint32_t>> constants;  ///< id and value, sorted
    std::array<uint32_t, 3> groups{};
    std::array<uint32_t, 3> workgroupSize{};
};

/// Data that reaches a buffer before the first pass.
struct RecordedUpload {
    std::shared_ptr<const BufferStorage> buffer;
    uint64_t offset = 0;      ///< in the buffer
    size_t at = 0, size = 0;  ///< in RecordedFrame::uploadData
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

/// A history between frames.
struct HistoryState {
    Format format{};
    Extent extent;
    uint32_t currentHalf = 0;  ///< which half the last executed frame wrote
    bool valid = false;
};

struct FrameGraph::Impl {
    RecordedFrame frame;
    std::set<std::string, std::less<>> names;  ///< of this frame's images
    std::map<std::string, HistoryState> histories;
    std::map<std::string, uint32_t> recordedHistories;  ///< of this frame, with the index of `current`
    bool resetRequested = false;
    std::map<std::string, std::shared_ptr<const Shader>, std::less<>> shaders;
    std::vector<ResourceUse> imageUses;
    std::map<const BufferStorage*, ResourceUse> bufferUses;
    size_t lastBarrier = 0;  ///< the last pass that waits: all before it are done by then
    std::unique_ptr<FrameExecutor> executor;

    Impl();
    ~Impl();

    void requireRecording() const;
    void commitHistories();
    ImageHandle addImage(RecordedImage image);
    void claimName(const std::string& name);
    /// Index of a handle of this frame; throws Error if it is empty or of another frame.
    uint32_t indexOf(ImageHandle handle) const;
    std::shared_ptr<const Shader> shaderOf(const ShaderCode& code);
    FrameExecutor& executorFor(Device& device);
    /// For downloads and times: throws Error unless a frame was executed on `device`.
    FrameExecutor& executed(Device& device) const;
};

}  // namespace limpid::gpu
