// One sequence of `limpid bench quality`, from its files to its numbers.
#pragma once

#include <vector>

#include "gpu/vulkan/device.h"
#include "lab/quality/quality_methods.h"
#include "lab/quality/quality_options.h"
#include "lab/quality/quality_run.h"

namespace limpid::cli {

/// Loads and measures a sequence, or says why it is skipped: --quick skips large scenes, and an optional
/// sequence that cannot be loaded is skipped, too. `pictureBytes`: what the pictures for a report may take.
/// Throws InputError if another sequence cannot be loaded.
QualityOutcome measureSequence(gpu::Device& device, const QualityOptions& options,
                               const std::vector<QualityMethod>& methods, const QualitySequence& sequence,
                               uint64_t pictureBytes);

}  // namespace limpid::cli
