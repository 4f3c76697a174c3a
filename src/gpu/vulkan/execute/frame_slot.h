// What one frame under way owns: descriptors, parameters, timestamps, and commands unless they are recorded
// into the caller's. Slots take turns.
#pragma once

#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/memory/buffer.h"

namespace limpid::gpu {

class FrameSlot {
  public:
    /// `prefix`: before the names of what it makes.
    FrameSlot(std::shared_ptr<const Context> context, uint32_t index, const GraphOptions& options);

    /// Waits until the slot's last frame is done, then makes room for `frame`.
    void begin(const RecordedFrame& frame);
    void submit(const RecordedFrame& frame);
    /// The same around commands of the caller's, who knows that the slot's last frame is done.
    /// Returns the times of that last frame.
    std::vector<PassTime> beginForeign(const RecordedFrame& frame, VkCommandBuffer commands);
    void endForeign(const RecordedFrame& frame);
    void wait();
    /// Runs the commands so far to their end, in the middle of a frame.
    void flush();

    VkCommandBuffer commands() const { return commands_; }
    VkDescriptorSet allocateSet(VkDescriptorSetLayout layout, const std::string& name);
    /// Copies a parameter struct into the uniform ring.
    VkDescriptorBufferInfo pushParams(std::span<const std::byte> params);
    /// Copies a frame's uploads to where the device can copy them from.
    VkBuffer stage(std::span<const std::byte> data);
    /// After the passes so far, the clock is read: stamp 0 before the first pass, stamp i + 1 after pass i.
    void writeTimestamp(uint32_t stamp);
    /// Of the slot's last frame. Waits for it if it was submitted here; otherwise it must be done.
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
    VkCommandBuffer commands_ = VK_NULL_HANDLE;  ///< that are being recorded
    UniqueFence fence_;
    bool submitted_ = false;  ///< the fence will be signalled

    UniqueDescriptorPool descriptors_;
    std::array<uint32_t, bindingKindCount> descriptorCapacity_{};  ///< by BindingKind
    uint32_t setCapacity_ = 0;

    std::shared_ptr<BufferStorage> params_;
    uint64_t paramsUsed_ = 0;
    std::shared_ptr<BufferStorage> staging_;

    UniqueQueryPool timestamps_;
    uint32_t timestampCapacity_ = 0;
    std::vector<std::string> passNames_;  ///< of the submitted frame

    /// What the frame uses, kept until it is done.
    std::vector<std::shared_ptr<const BufferResource>> buffers_;
    std::vector<std::shared_ptr<const StructuresResource>> structures_;
};

}  // namespace limpid::gpu
