#include "scene/device/tables/alias_table.h"

#include <numeric>

namespace limpid::scene {

AliasTable buildAliasTable(std::vector<double> weights) {
    const size_t count = weights.size();
    AliasTable table;
    table.entries.resize(count);
    table.probabilities.resize(count);
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double>& scaled = weights;
    // Two stacks in one array, which grow towards each other: every entry is in at most one of them.
    std::vector<uint32_t> stacks(count);
    size_t smallEnd = 0, largeBegin = count;
    for (size_t i = 0; i < count; ++i) {
        scaled[i] = sum > 0.0 ? weights[i] / sum * static_cast<double>(count) : 1.0;
        table.probabilities[i] = static_cast<float>(scaled[i] / static_cast<double>(count));
        table.entries[i] = {1.0f, static_cast<uint32_t>(i)};
        stacks[scaled[i] < 1.0 ? smallEnd++ : --largeBegin] = static_cast<uint32_t>(i);
    }
    while (smallEnd > 0 && largeBegin < count) {
        const uint32_t poor = stacks[--smallEnd], rich = stacks[largeBegin];
        table.entries[poor] = {static_cast<float>(scaled[poor]), rich};
        scaled[rich] -= 1.0 - scaled[poor];
        if (scaled[rich] < 1.0) {
            ++largeBegin;
            stacks[smallEnd++] = rich;
        }
    }
    return table;
}

}  // namespace limpid::scene
