// The inside of Device, for the other files of this folder.
#pragma once

#include "gpu/vulkan/memory/transfer.h"

namespace limpid::gpu {

struct Device::Impl {
    explicit Impl(const DeviceOptions& options)
        : context(std::make_shared<const Context>(options)), transfer(context) {}

    std::shared_ptr<const Context> context;
    Transfer transfer;
};

}  // namespace limpid::gpu
