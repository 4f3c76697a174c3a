#include "scene/alias_table.h"

#include <numeric>

namespace limpid::scene {

AliasTable buildAliasTable(std::span<const double> weights) {
    const size_t count = weights.size();
    AliasTable table;
    table.entries.resize(count);
    table.probabilities.resize(count);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> scaled(count, 1.0);
    std::vector<uint32_t> small, large;
    for (size_t i = 0; i < count; ++i) {
        if (sum > 0.0) scaled[i] = weights[i] / sum * static_cast<double>(count);
        table.probabilities[i] = static_cast<float>(scaled[i] / static_cast<double>(count));
        table.entries[i] = {1.0f, static_cast<uint32_t>(i)};
        (scaled[i] < 1.0 ? small : large).push_back(static_cast<uint32_t>(i));
    }
    while (!small.empty() && !large.empty()) {
        const uint32_t poor = small.back(), rich = large.back();
        small.pop_back();
        table.entries[poor] = {static_cast<float>(scaled[poor]), rich};
        scaled[rich] -= 1.0 - scaled[poor];
        if (scaled[rich] < 1.0) {
            large.pop_back();
            small.push_back(rich);
        }
    }
    return table;
}

}  // namespace limpid::scene
