// Keeps outputs from replacing inputs.
#pragma once

#include "shot/run/shot_request.h"

namespace limpid::shot {

/// Throws UsageError if an output is a file that this job or another one of the same shot reads.
void refuseReplacing(const ShotRequest& request, const ShotJob& job);

}  // namespace limpid::shot
