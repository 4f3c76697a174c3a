// std::partition() on all cores.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace limpid::scene {

/// Moves the elements for which `isLeft` holds before the others, and returns how many they are. The order of
/// the result depends on the arguments alone, not on the threads.
template <typename T, typename IsLeft>
size_t partitionInParallel(std::span<T> all, const IsLeft& isLeft) {
    constexpr size_t block = size_t{1} << 16;
    if (all.size() < 2 * block)
        return static_cast<size_t>(std::partition(all.begin(), all.end(), isLeft) - all.begin());
    const size_t count = (all.size() + block - 1) / block;
    const auto blockAt = [&](size_t i) {
        return all.subspan(i * block, std::min(block, all.size() - i * block));
    };
    std::vector<size_t> lefts(count);
    tbb::parallel_for(size_t{0}, count, [&](size_t i) {
        const std::span<T> part = blockAt(i);
        lefts[i] = static_cast<size_t>(std::partition(part.begin(), part.end(), isLeft) - part.begin());
    });
    size_t middle = 0;
    for (const size_t left : lefts) middle += left;
    // Each block has its left ones first. Those behind the middle change places with right ones before it.
    std::vector<std::span<T>> rightsBefore, leftsBehind;
    const auto before = all.first(middle);
    for (size_t i = 0; i < count; ++i) {
        const std::span<T> part = blockAt(i), left = part.first(lefts[i]), right = part.subspan(lefts[i]);
        const size_t partAt = i * block, rightAt = partAt + lefts[i];
        if (rightAt < middle)
            rightsBefore.push_back(before.subspan(rightAt, std::min(right.size(), middle - rightAt)));
        if (rightAt > middle) leftsBehind.push_back(left.subspan(middle > partAt ? middle - partAt : 0));
    }
    struct Exchange {
        std::span<T> a, b;
    };
    std::vector<Exchange> exchanges;
    for (size_t i = 0, j = 0; i < rightsBefore.size() && j < leftsBehind.size();) {
        std::span<T>&a = rightsBefore[i], &b = leftsBehind[j];
        const size_t both = std::min(a.size(), b.size());
        exchanges.push_back({a.first(both), b.first(both)});
        a = a.subspan(both);
        b = b.subspan(both);
        i += a.empty();
        j += b.empty();
    }
    tbb::parallel_for(size_t{0}, exchanges.size(), [&](size_t i) {
        std::swap_ranges(exchanges[i].a.begin(), exchanges[i].a.end(), exchanges[i].b.begin());
    });
    return middle;
}

}  // namespace limpid::scene
