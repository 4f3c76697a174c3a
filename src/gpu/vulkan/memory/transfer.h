// Copies between host and device in chunks of bounded size. Each call waits until its copies are finished.
#pragma once

#include <functional>
#include <mutex>
#include <span>

#include "gpu/vulkan/memory/buffer.h"
#include "gpu/vulkan/memory/image.h"

namespace limpid::gpu {

/// Makes writes of earlier frames visible to a copy.
void beforeCopy(const Context& context, VkCommandBuffer commands);
/// Makes the copy visible to the host. Frames begin with a barrier of their own.
void afterCopy(const Context& context, VkCommandBuffer commands);

class Transfer {
  public:
    explicit Transfer(std::shared_ptr<const Context> context);

    void upload(const BufferStorage& buffer, std::span<const std::byte> data);
    void zero(const BufferStorage& buffer);
    void download(const BufferStorage& buffer, std::span<std::byte> data);
    /// `data` has tightly packed rows, row 0 first.
    void download(const Image& image, std::span<std::byte> data);

    /// Records commands with `record`, submits them and waits.
    void run(const std::function<void(VkCommandBuffer)>& record);

  private:
    /// Returns a staging buffer of at least `bytes`, at most one chunk; reused until a larger one is needed.
    const BufferStorage& staging(BufferUse use, uint64_t bytes);

    std::shared_ptr<const Context> context_;
    std::recursive_mutex mutex_;  ///< shared by everything on the device, so copies take turns
    UniqueCommandPool pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    UniqueFence fence_;
    std::shared_ptr<BufferStorage> upload_, download_;
};

}  // namespace limpid::gpu
