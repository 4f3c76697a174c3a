// Converts formats to Vulkan's.
#pragma once

#include "gpu/graph/shader_code.h"
#include "gpu/vulkan/vk.h"

namespace limpid::gpu {

VkFormat toVulkan(Format format);

}  // namespace limpid::gpu
