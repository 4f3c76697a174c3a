// The Vulkan API, loaded at run time by volk: without Vulkan, Limpid still starts and says what is missing.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <volk.h>
