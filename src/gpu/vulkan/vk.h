// The Vulkan API: types, but no function prototypes (gpu/vulkan/functions.h loads functions at run time). So
// without Vulkan, Limpid still starts and can report what is missing.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan.h>
