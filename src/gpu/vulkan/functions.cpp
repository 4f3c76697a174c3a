#include "gpu/vulkan/functions.h"

#include <dlfcn.h>

namespace limpid::gpu {

LoaderFunctions::LoaderFunctions(PFN_vkGetInstanceProcAddr getInstanceProcAddr)
    : GetInstanceProcAddr(getInstanceProcAddr) {
#define LIMPID_LOAD(name) \
    name = reinterpret_cast<PFN_vk##name>(getInstanceProcAddr(VK_NULL_HANDLE, "vk" #name));
    LIMPID_LOADER_FUNCTIONS(LIMPID_LOAD)
#undef LIMPID_LOAD
}

InstanceFunctions::InstanceFunctions(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance) {
#define LIMPID_LOAD(name) name = reinterpret_cast<PFN_vk##name>(getInstanceProcAddr(instance, "vk" #name));
    LIMPID_INSTANCE_FUNCTIONS(LIMPID_LOAD)
#undef LIMPID_LOAD
}

DeviceFunctions::DeviceFunctions(const InstanceFunctions& instance, VkDevice of) : device(of) {
#define LIMPID_LOAD(name) name = reinterpret_cast<PFN_vk##name>(instance.GetDeviceProcAddr(of, "vk" #name));
    LIMPID_DEVICE_FUNCTIONS(LIMPID_LOAD)
#undef LIMPID_LOAD
}

PFN_vkGetInstanceProcAddr systemLoader() {
    // Never closed, since drivers keep threads and exit handlers in it.
    static void* const library = [] {
        void* found = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
        return found ? found : dlopen("libvulkan.so", RTLD_NOW | RTLD_LOCAL);
    }();
    return library ? reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"))
                   : nullptr;
}

}  // namespace limpid::gpu
