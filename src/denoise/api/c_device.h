// Opening a device as the C interfaces describe it.
#pragma once

#include <memory>

#include "gpu/vulkan/device.h"
#include "limpid/denoise.h"

namespace limpid::denoise {

/// Empty if `message` is null.
MessageCallback callbackOf(limpid_message_callback message, void* user);

/// A device of Limpid's own; `desc` may be null. Throws gpu::Unsupported if none fits.
std::shared_ptr<gpu::Device> openDevice(const limpid_device_desc* desc);

}  // namespace limpid::denoise
