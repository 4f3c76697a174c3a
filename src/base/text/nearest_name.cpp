#include "base/text/nearest_name.h"

#include <algorithm>
#include <vector>

namespace limpid {
namespace {

std::string lowered(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

}  // namespace

size_t editDistance(std::string_view a, std::string_view b) {
    // Rows of the table of distances between beginnings of a and b: this one and the two before.
    std::vector<size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, last);
        std::swap(last, row);
    }
    return last[b.size()];
}

std::string nearestName(std::string_view text, std::span<const std::string> names) {
    constexpr size_t shortest = 3;
    const std::string wanted = lowered(text);
    size_t least = wanted.size() <= 4 ? 2 : 3;
    std::string best;
    for (const std::string& name : names) {
        const std::string candidate = lowered(name);
        size_t distance = editDistance(wanted, candidate);
        const bool begins = candidate.starts_with(wanted) || wanted.starts_with(candidate);
        if (begins && std::min(wanted.size(), candidate.size()) >= shortest)
            distance = std::min(distance, size_t{1});
        if (distance >= least) continue;
        least = distance;
        best = name;
    }
    return best;
}

std::string didYouMean(std::string_view text, std::span<const std::string> names) {
    const std::string name = nearestName(text, names);
    return name.empty() ? std::string() : "; did you mean '" + name + "'?";
}

}  // namespace limpid
