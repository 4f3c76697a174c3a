// Formats as Vulkan names them.
#pragma once

#include <span>

#include "gpu/graph/shader.h"
#include "gpu/vulkan/vk.h"

namespace limpid::gpu {

VkFormat toVulkan(Format format);
std::span<const Format> allFormats();

}  // namespace limpid::gpu
