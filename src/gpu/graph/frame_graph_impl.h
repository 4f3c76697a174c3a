// The internals of FrameGraph: the data that recording leaves for execution. Makes no Vulkan calls.
#pragma once

#include <map>
#include <optional>
#include <set>

#include "gpu/graph/frame_graph.h"

namespace limpid::gpu {

class FrameExecutor;

/// A compute shader, or the shaders of a ray-tracing pipeline (ray generation first) with their merged
/// declarations. Kept alive by the frames and pipelines that use it.
struct Shader {
    uint64_t hash = 0;  ///< of all stages; equal hashes mean the same shader
    using Stage = ShaderCode;
    std::string name;  ///< of the first stage
    std::vector<Stage> stages;
    ShaderReflection reflection;
    MergedDeclarations merged;                              ///< for several stages: the data behind
                                                            ///< `reflection`
    std::vector<std::shared_ptr<const ShaderCode>> owners;  ///< own the data of replaced shaders

    bool tracesRays() const { return reflection.stage == ShaderStage::RayGeneration; }
};

/// Identifies the device image behind a recorded image. `half` distinguishes the two of a history pair.
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
    ForeignImage foreign;  ///< for role Foreign
    bool clear = false;    ///< zeroed before the first pass: an invalid history
    bool written = false;
    bool uploaded = false;  ///< written before the first pass
    /// The earlier image whose memory this one uses (memory_sharing.cpp), an index into images. They have the
    /// same key.
    std::optional<uint32_t> sharesWith;
    bool overwritten = false;  ///< another image uses its memory later in the frame, or in another format
    /// For role Foreign: whether a pass samples it or binds it as a storage image. It cannot be in both
    /// layouts.
    bool sampled = false, stored = false;

    Extent extent() const { return {key.width, key.height}; }
    uint64_t bytes() const { return uint64_t{key.width} * key.height * bytesPerTexel(key.format); }
};

struct BoundResource {
    uint32_t binding = 0;
    BindingKind kind{};
    uint32_t image = 0;  ///< index into images
    /// A buffer, or the buffer with the top level of acceleration structures.
    std::shared_ptr<const BufferResource> buffer;
    std::shared_ptr<const StructuresResource> structures;
};

struct RecordedDispatch {
    std::shared_ptr<const Shader> shader;  ///< none: rebuilds the acceleration structures, its only resource
    std::vector<BoundResource> resources;
    uint32_t paramsBinding = 0;
    size_t paramsOffset = 0, paramsSize = 0;  ///< in RecordedFrame::params; size 0: no uniform block
    std::vector<std::pair<uint32_t, uint32_t>> constants;  ///< id and value, sorted
    std::array<uint32_t, 3> groups{};
    std::array<uint32_t, 3> workgroupSize{};
    std::function<void(std::span<const std::span<std::byte>>)>
        host;                          ///< set instead of all members above if the pass runs on the CPU
    std::vector<uint32_t> hostImages;  ///< indices into images, in the order of `host`
};

/// Data that is copied to a buffer or an image before the first pass.
struct RecordedUpload {
    std::shared_ptr<const BufferResource> buffer;  ///< none: the target is an image
    uint64_t offset = 0;                           ///< in the buffer
    uint32_t image = 0;                            ///< index into images
    size_t at = 0, size = 0;                       ///< in the staging buffer
    const std::byte* borrowed = nullptr;           ///< the caller's data; null: RecordedFrame::uploadData
    size_t copied = 0;                             ///< where in uploadData
};

/// One access of a pass to a resource.
struct Access {
    const BufferResource* buffer = nullptr;  ///< for buffers
    uint32_t image = 0;                      ///< index into images
    std::string name;
    bool reads = false, writes = false;
};

/// Everything recorded for one frame.
struct RecordedFrame {
    uint64_t number = 0;
    std::vector<RecordedUpload> uploads;
    std::vector<std::byte> uploadData;  ///< of the uploads that are not borrowed
    size_t stagingBytes = 0;            ///< of all uploads

    /// Gives the upload a place in the staging buffer. Copies to images start at multiples of a texel.
    void add(RecordedUpload upload, std::span<const std::byte> data, bool copies) {
        upload.at = (stagingBytes + 15) / 16 * 16;
        upload.size = data.size();
        stagingBytes = upload.at + upload.size;
        if (copies) {
            upload.copied = uploadData.size();
            uploadData.insert(uploadData.end(), data.begin(), data.end());
        } else {
            upload.borrowed = data.data();
        }
        uploads.push_back(std::move(upload));
    }
    std::vector<RecordedImage> images;
    std::vector<RecordedPass> passes;
    std::vector<RecordedDispatch> dispatches;   ///< one per pass
    std::vector<std::vector<Access>> accesses;  ///< one per pass, with GraphOptions::shareMemory
    std::vector<std::byte> params;
    bool executed = false;
};

/// The last accesses to a resource that later passes may have to wait for.
struct ResourceUse {
    static constexpr size_t none = SIZE_MAX;
    size_t lastWriter = none;
    std::vector<size_t> readers;  ///< since the last write
};

/// The state of a history between frames.
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
    std::set<std::string, std::less<>> names;  ///< of images in this frame
    std::map<std::string, HistoryState> histories;
    std::map<std::string, uint32_t> recordedHistories;  ///< in this frame, with the index of `current`
    bool resetRequested = false;
    std::map<std::string, std::shared_ptr<const Shader>, std::less<>> shaders;
    const ShaderReplacements* replacements = nullptr;
    std::function<bool()> interrupted;   ///< see setInterruption()
    std::vector<ResourceUse> imageUses;  ///< of the images' memory
    std::map<const BufferResource*, ResourceUse> bufferUses;
    size_t lastBarrier = 0;                   ///< the last pass that waits: all passes before it are finished
                                              ///< by then
    std::shared_ptr<FrameExecutor> executor;  ///< none if only recording; only gpu/vulkan uses its content

    explicit Impl(GraphOptions options);
    ~Impl();

    void requireRecording() const;
    ResourceUse& useOf(const Access& access);
    void commitHistories();
    ImageHandle addImage(RecordedImage image);
    void claimName(const std::string& name);
    /// Returns the index of a handle; throws Error if it is empty or from another frame.
    uint32_t indexOf(ImageHandle handle) const;
    /// Returns the index of an image that may be uploaded, and notes that it is; throws Error for others.
    uint32_t uploadTarget(ImageHandle handle, size_t bytes);
    std::shared_ptr<const Shader> shaderOf(const ShaderCode& code, const RayShaders* rays);
    /// Returns the replacement of the code, or the code itself without an owner.
    std::shared_ptr<const ShaderCode> replaced(const ShaderCode& code) const;
    /// Determines what the next pass must wait for, then records its accesses.
    void noteAccesses(RecordedPass& pass, std::span<const Access> accesses);
    /// Determines what pass `number` must wait for; the passes before it have been noted.
    void findHazards(RecordedPass& pass, size_t number, std::span<const Access> accesses);
    /// Returns for each image the one whose memory it uses: itself, or an earlier one.
    std::vector<uint32_t> planMemory() const;
    /// Applies planMemory() once the frame is complete: from then on hazards are those of memory.
    void shareMemory();
    FrameExecutor& executorFor(Device& device);
    /// Checks that everything the frame uses lies on `device`, and returns the executor that runs it.
    FrameExecutor& readyToRun(Device& device);
    /// For downloads and pass times: throws Error unless a frame was executed on `device`.
    FrameExecutor& executed(Device& device) const;
};

}  // namespace limpid::gpu
