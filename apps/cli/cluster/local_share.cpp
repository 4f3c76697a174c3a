#include "cli/cluster/local_share.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <vector>

#include "base/text/lower_case.h"

namespace limpid::cli {
std::string deviceOfProcess(std::span<const gpu::DeviceInfo> devices, const std::string& select,
                            int localRank) {
    const std::string wanted = lowerCase(select);
    if (!wanted.empty() &&
        (wanted == "cpu" || std::ranges::all_of(wanted, [](unsigned char c) { return std::isdigit(c); })))
        return select;
    std::optional<gpu::DeviceType> best;
    for (const gpu::DeviceInfo& info : devices)
        if (info.usable && (!best || info.type < *best)) best = info.type;
    std::vector<uint32_t> candidates;
    for (const gpu::DeviceInfo& info : devices) {
        const bool matches =
            wanted.empty() ? info.type == *best : lowerCase(info.name).find(wanted) != std::string::npos;
        if (info.usable && matches) candidates.push_back(info.index);
    }
    if (candidates.size() < 2) return select;
    return std::to_string(candidates[static_cast<size_t>(localRank) % candidates.size()]);
}

int threadsOfProcess(int allowed, int all, int localSize) {
    const bool boundApart = allowed * localSize <= all;
    return std::max(1, boundApart ? allowed : allowed / localSize);
}

}  // namespace limpid::cli
