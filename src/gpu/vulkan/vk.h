// The Vulkan API: types, and prototypes of none of its functions (gpu/vulkan/functions.h loads them at run
// time). Without Vulkan, Limpid still starts and says what is missing.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan.h>
