// Runs recorded frames on a device.
#pragma once

#include "gpu/vulkan/device_impl.h"
#include "gpu/vulkan/execute/frame_slot.h"
#include "gpu/vulkan/execute/pipeline_cache.h"
#include "gpu/vulkan/memory/image_pool.h"

namespace limpid::gpu {

class FrameExecutor {
  public:
    explicit FrameExecutor(std::shared_ptr<const Context> context);
    ~FrameExecutor();

    const Context& context() const { return *context_; }
    void execute(const RecordedFrame& frame);
    /// The device image behind an image of a frame that was executed.
    const Image& image(const RecordedImage& recorded) const;
    std::vector<PassTime> passTimes();
    size_t pooledImages() const { return images_.size(); }

  private:
    void prepareImages(const RecordedFrame& frame, VkCommandBuffer commands);
    void clearHistories(const RecordedFrame& frame, VkCommandBuffer commands);
    void recordUploads(const RecordedFrame& frame, FrameSlot& slot);
    void recordPass(const RecordedFrame& frame, size_t index, FrameSlot& slot);
    void runOnHost(const RecordedFrame& frame, size_t index, FrameSlot& slot);
    void recordDispatch(const RecordedFrame& frame, size_t index, FrameSlot& slot);
    VkDescriptorSet writeDescriptors(const RecordedFrame& frame, size_t index, VkDescriptorSetLayout layout,
                                     FrameSlot& slot);
    void checkGroups(const RecordedFrame& frame, size_t index) const;
    void beginLabel(VkCommandBuffer commands, const std::string& name) const;
    void endLabel(VkCommandBuffer commands) const;

    std::shared_ptr<const Context> context_;
    ImagePool images_;
    PipelineCache pipelines_;
    std::array<FrameSlot, 2> slots_;
    std::vector<ImagePool::Entry*> frameImages_;  ///< by the index of the recorded image
    uint64_t submitted_ = 0;                      ///< frames so far
};

}  // namespace limpid::gpu
