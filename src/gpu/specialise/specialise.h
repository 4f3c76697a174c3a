// Removes from a shader what its specialisation constants switch off, before the driver compiles it. Drivers
// that translate a whole module first do much work for nothing: lavapipe takes 1.4 s for the path tracer of a
// scene without textures, environment and volumes, and 0.4 s for what is left of it here.
#pragma once

#include "gpu/vulkan/device.h"

namespace limpid::gpu {

/// For DeviceOptions::specialise. Null if Limpid was built without SPIRV-Tools' optimiser.
Specialise specialiser();

}  // namespace limpid::gpu
