// Checks every VkResult, in Release builds too.
#pragma once

#include <string>
#include <string_view>

#include "gpu/vulkan/vk.h"

namespace limpid::gpu {

/// Returns the result's name, such as "VK_ERROR_DEVICE_LOST".
std::string resultName(VkResult result);

/// Returns what the result means to a user, such as "out of device memory" or "the device was lost ..."; ""
/// for other results.
std::string_view resultMeaning(VkResult result);

/// Throws Error unless `result` is VK_SUCCESS (DeviceLost if the device was lost). The message has the
/// result's meaning and name, the call and its source location.
void checkResult(VkResult result, const char* expression, const char* file, int line);

}  // namespace limpid::gpu

/// A macro because the message includes the expression, the file and the line.
#define LIMPID_VK(expression) ::limpid::gpu::checkResult((expression), #expression, __FILE__, __LINE__)
