// What host passes see of images in buffers.
#pragma once

#include <cstddef>
#include <span>

namespace limpid::gpu {

/// The bytes as numbers of this type, of which they were made.
template <typename T>
std::span<T> elementsOf(std::span<std::byte> bytes) {
    return {reinterpret_cast<T*>(bytes.data()), bytes.size() / sizeof(T)};
}

}  // namespace limpid::gpu
