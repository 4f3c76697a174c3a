// What one of several processes on a machine takes: a device, and some of the cores.
#pragma once

#include <span>
#include <string>

#include "gpu/vulkan/device.h"

namespace limpid::cli {

/// Which device the process takes that is number `localRank` on its machine, as DeviceOptions::select: of the
/// devices that `select` (the user's choice) names, or of the best kind, each process the next one, and again
/// from the first when there are more processes. `select` itself if that names one device or none.
std::string deviceOfProcess(std::span<const gpu::DeviceInfo> devices, const std::string& select,
                            int localRank);

/// How many threads a process should have. `allowed`: cores that the launcher lets it use, of `all` of the
/// machine. Where that is all that the launcher does, the processes of the machine have an equal share each;
/// at least 1.
int threadsOfProcess(int allowed, int all, int localSize);

}  // namespace limpid::cli
