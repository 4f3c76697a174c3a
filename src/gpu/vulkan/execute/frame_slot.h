// The resources of one frame in flight: descriptors, parameters, timestamps, and a command buffer unless
// frames are recorded into the caller's. Slots are used in turn.
#pragma once

#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/memory/buffer.h"

namespace limpid::gpu {

class FrameSlot {
  public:
    /// options.prefix is put before the names of the objects created here.
    FrameSlot(std::shared_ptr<const Context> context, uint32_t index, const GraphOptions& options);

    /// Waits until the slot's last frame is finished, then prepares for `frame`.
    void begin(const RecordedFrame& frame);
    void submit(const RecordedFrame& frame);
    /// Like begin(), but for the caller's commands; the caller ensures that the slot's last frame is
    /// finished. Returns the times of that frame.
    std::vector<PassTime> beginForeign(const RecordedFrame& frame, VkCommandBuffer commands);
    void endForeign(const RecordedFrame& frame);
    void wait();
    /// Keeps it alive until the slot's next frame begins.
    void keep(std::shared_ptr<const void> used) { used_.push_back(std::move(used)); }
    /// Submits the commands recorded so far and waits for them, in the middle of a frame.
    void flush();

    VkCommandBuffer commands() const { return commands_; }
    VkDescriptorSet allocateSet(VkDescriptorSetLayout layout);
    /// Copies a parameter struct into the uniform ring buffer.
    VkDescriptorBufferInfo pushParams(std::span<const std::byte> params);
    /// Copies uploads into a staging buffer, from its beginning. `copies` are those that are not borrowed.
    /// Makes room for so many bytes of uploads. This may fail, and so comes before the frame's first command.
    void reserveStaging(uint64_t bytes);
    VkBuffer stage(std::span<const RecordedUpload> uploads, std::span<const std::byte> copies);
    /// Writes a timestamp after the passes so far: number 0 before the first pass, number i + 1 after pass i.
    void writeTimestamp(uint32_t stamp);
    /// Returns the times of the slot's last frame. Waits for it if it was submitted here; otherwise it must
    /// be finished.
    std::vector<PassTime> passTimes();

  private:
    std::string name(const char* what) const;
    void makeCommands();
    void makeRoom(const RecordedFrame& frame);
    void keep(const RecordedFrame& frame);
    void reserveDescriptors(const RecordedFrame& frame);
    void reserveParams(const RecordedFrame& frame);
    void reserveTimestamps(uint32_t count);
    uint64_t alignedSize(uint64_t bytes) const;

    std::shared_ptr<const Context> context_;
    uint32_t index_;
    std::string prefix_;
    bool timed_;
    UniqueCommandPool commandPool_;
    VkCommandBuffer ownCommands_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;  ///< currently being recorded
    UniqueFence fence_;
    bool submitted_ = false;  ///< the fence will be signalled

    UniqueDescriptorPool descriptors_;
    std::array<uint32_t, bindingKindCount> descriptorCapacity_{};  ///< indexed by BindingKind
    uint32_t setCapacity_ = 0;

    std::shared_ptr<BufferStorage> params_;
    uint64_t paramsUsed_ = 0;
    std::shared_ptr<BufferStorage> staging_;

    UniqueQueryPool timestamps_;
    uint32_t timestampCapacity_ = 0;
    std::vector<std::string> passNames_;  ///< of the submitted frame

    /// Resources that the frame uses, kept alive until it is finished.
    std::vector<std::shared_ptr<const BufferResource>> buffers_;
    std::vector<std::shared_ptr<const StructuresResource>> structures_;
    std::vector<std::shared_ptr<const void>> used_;
};

}  // namespace limpid::gpu
