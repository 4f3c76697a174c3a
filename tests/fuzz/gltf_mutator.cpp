// Mutations that keep the JSON of a glTF input valid, so that most inputs pass the parser: values are
// replaced, exchanged, repeated, removed. libFuzzer's own mutations do the rest, including the whole binary
// part.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "scratch.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t maxSize);

namespace limpid::fuzz {
namespace {

using nlohmann::json;
using Random = std::minstd_rand;

size_t below(Random& random, size_t n) {
    return std::uniform_int_distribution<size_t>(0, n - 1)(random);
}

void collect(json& value, std::vector<json*>& all) {
    all.push_back(&value);
    if (!value.is_structured()) return;
    for (json& child : value) collect(child, all);
}

json interestingValue(Random& random) {
    static const std::vector<json> values = {0,
                                             1,
                                             2,
                                             3,
                                             4,
                                             5,
                                             6,
                                             -1,
                                             5120,
                                             5121,
                                             5122,
                                             5123,
                                             5125,
                                             5126,
                                             9728,
                                             9987,
                                             10497,
                                             33071,
                                             255,
                                             252,
                                             256,
                                             65535,
                                             65536,
                                             16777216,
                                             1u << 28,
                                             1u << 31,
                                             1e-45,
                                             1e-30,
                                             1e10,
                                             1e18,
                                             3e38,
                                             4294967295u,
                                             1e300,
                                             0.5,
                                             -0.5,
                                             -0.0,
                                             3.14159,
                                             true,
                                             false,
                                             nullptr,
                                             "",
                                             "MASK",
                                             "BLEND",
                                             "VEC2",
                                             "VEC3",
                                             "VEC4",
                                             "MAT4",
                                             "SCALAR",
                                             "a.png",
                                             "point",
                                             "spot",
                                             "../x",
                                             "%",
                                             "directional",
                                             "LINEAR",
                                             "STEP",
                                             "weights",
                                             "scene.bin",
                                             "rotation",
                                             "CUBICSPLINE",
                                             "translation",
                                             json::array(),
                                             json::object()};
    return values[below(random, values.size())];
}

void changeNumber(json& value, Random& random) {
    if (value.is_number_float()) {
        const double factors[] = {0.0, -1.0, 0.5, 2.0, 1e-20, 1e20};
        value = value.get<double>() * factors[below(random, std::size(factors))];
    } else {
        value = value.get<int64_t>() + static_cast<int64_t>(below(random, 9)) - 4;
    }
}

void changeContainer(json& value, const json& other, Random& random) {
    const bool grow = value.empty() || below(random, 2) == 0;
    if (value.is_array() && grow) {
        value.push_back(other);
    } else if (value.is_array()) {
        value.erase(below(random, value.size()));
    } else if (value.is_object() && grow && other.is_object() && !other.empty()) {
        const auto item = std::next(other.begin(), static_cast<std::ptrdiff_t>(below(random, other.size())));
        value[item.key()] = item.value();
    } else if (value.is_object() && !value.empty()) {
        value.erase(std::next(value.begin(), static_cast<std::ptrdiff_t>(below(random, value.size()))));
    }
}

void edit(json& document, Random& random) {
    std::vector<json*> all;
    collect(document, all);
    json& value = *all[below(random, all.size())];
    const json other = *all[below(random, all.size())];
    switch (below(random, 4)) {
        case 0:
            value = interestingValue(random);
            break;
        case 1:
            value = other;
            break;
        default:
            if (value.is_number()) {
                changeNumber(value, random);
            } else if (value.is_structured()) {
                changeContainer(value, other, random);
            } else {
                value = interestingValue(random);
            }
    }
}

/// Returns the changed text, or nothing if the text is not JSON.
std::string edited(Bytes text, Random& random) {
    const auto* begin = reinterpret_cast<const char*>(text.data());
    json document = json::parse(begin, begin + text.size(), nullptr, false);
    if (document.is_discarded()) return {};
    for (size_t i = 0, edits = 1 + below(random, 3); i < edits; ++i) edit(document, random);
    return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace
}  // namespace limpid::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    using namespace limpid::fuzz;
    Random random(seed);
    const Parts parts = splitAtZero(std::as_bytes(std::span(data, size)));
    const size_t choice = below(random, 8);
    if (choice == 0) return LLVMFuzzerMutate(data, size, maxSize);
    if (choice <= 2 && parts.split && !parts.second.empty()) {
        const size_t kept = parts.first.size() + 1;
        return kept + LLVMFuzzerMutate(data + kept, size - kept, maxSize - kept);
    }
    const std::string text = edited(parts.first, random);
    const size_t rest = size - parts.first.size();
    if (text.empty() || text.size() + rest > maxSize) return LLVMFuzzerMutate(data, size, maxSize);
    std::memmove(data + text.size(), data + parts.first.size(), rest);
    std::memcpy(data, text.data(), text.size());
    return text.size() + rest;
}
