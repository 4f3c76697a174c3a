// The one translation unit that holds volk's function pointers; Debian ships volk as source.
#include <volk.c>

#include "gpu/vulkan/vk.h"
