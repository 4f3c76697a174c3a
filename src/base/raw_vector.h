// Vectors for large arrays that several threads fill: resize() leaves new elements as they are in memory,
// which is not even touched.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace limpid {

template <typename T>
struct RawAllocator : std::allocator<T> {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

    template <typename U>
    struct rebind {
        using other = RawAllocator<U>;
    };
    RawAllocator() = default;
    template <typename U>
    RawAllocator(const RawAllocator<U>&) {}

    template <typename U, typename... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        if constexpr (sizeof...(Arguments) > 0) std::construct_at(at, std::forward<Arguments>(arguments)...);
    }
};

/// Elements that resize() adds must be assigned before they are read, or copied as the vector grows:
/// reserve() first.
template <typename T>
using RawVector = std::vector<T, RawAllocator<T>>;

}  // namespace limpid
