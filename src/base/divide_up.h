// The number of groups of a size that a number of things needs.
#pragma once

#include <cstdint>

namespace limpid {

constexpr uint32_t divideUp(uint32_t a, uint32_t b) {
    return (a + b - 1) / b;
}

}  // namespace limpid
