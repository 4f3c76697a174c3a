// Every VkResult is looked at, in Release builds too.
#pragma once

#include <string>
#include <string_view>

#include "gpu/vulkan/vk.h"

namespace limpid::gpu {

/// "VK_ERROR_DEVICE_LOST" etc.
std::string resultName(VkResult result);

/// What the result means to a user: "out of device memory", "the device was lost ..."; "" if it has no such
/// meaning.
std::string_view resultMeaning(VkResult result);

/// Throws Error (DeviceLost if that is it) with the meaning, the name, the call and its place unless `result`
/// is VK_SUCCESS.
void checkResult(VkResult result, const char* expression, const char* file, int line);

}  // namespace limpid::gpu

/// A macro only because the message names the expression, the file and the line.
#define LIMPID_VK(expression) ::limpid::gpu::checkResult((expression), #expression, __FILE__, __LINE__)
