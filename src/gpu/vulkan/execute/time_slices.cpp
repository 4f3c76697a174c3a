#include "gpu/vulkan/execute/time_slices.h"

#include <algorithm>

namespace limpid::gpu {
namespace {

/// Groups of the first submission of a pass of which no time is known: about what a CPU core does in a slice.
constexpr uint64_t firstGroups = 64;

}  // namespace

uint32_t TimeSlices::rows(const std::string& pass, uint64_t groupsPerRow, uint32_t remaining) const {
    const auto known = secondsPerGroup_.find(pass);
    const double groups = known == secondsPerGroup_.end() || known->second <= 0.0
                              ? static_cast<double>(firstGroups)
                              : sliceSeconds / known->second;
    const double wanted = groups / static_cast<double>(std::max<uint64_t>(groupsPerRow, 1));
    return static_cast<uint32_t>(std::clamp(wanted, 1.0, static_cast<double>(remaining)));
}

double TimeSlices::seconds(const std::string& pass, uint64_t groups) const {
    const auto known = secondsPerGroup_.find(pass);
    return known == secondsPerGroup_.end() ? 0.0 : known->second * static_cast<double>(groups);
}

void TimeSlices::note(const std::string& pass, uint64_t groups, double seconds) {
    if (groups > 0) secondsPerGroup_[pass] = std::max(seconds, 1e-9) / static_cast<double>(groups);
}

}  // namespace limpid::gpu
