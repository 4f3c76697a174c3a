// The internals of Device, for other files in this folder.
#pragma once

#include <mutex>
#include <optional>

#include "gpu/vulkan/device.h"
#include "gpu/vulkan/execute/pipeline_cache.h"
#include "gpu/vulkan/memory/transfer.h"

namespace limpid::gpu {

struct Device::Impl {
    Impl(std::shared_ptr<const Context> on, const DeviceOptions& options)
        : context(std::move(on)),
          pipelines(std::make_shared<PipelineCache>(context, options.specialise, options.mostPipelines)) {}

    /// Created at the first copy: an adopted device may never need it.
    Transfer& transfer() {
        std::call_once(transferMade_, [&] { transfer_.emplace(context); });
        return *transfer_;
    }

    std::shared_ptr<const Context> context;
    std::shared_ptr<PipelineCache> pipelines;

  private:
    std::once_flag transferMade_;
    std::optional<Transfer> transfer_;
};

}  // namespace limpid::gpu
