// A 64-bit hash of bytes, to compare contents and to detect damage. Not cryptographic.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace limpid {

/// FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo, http://www.isthe.com/chongo/tech/comp/fnv/) over little-endian
/// words of eight bytes instead of bytes, with x ^= x >> 32 after each step; without it, the highest bits of
/// a word would never reach the lower bits. Every step is one-to-one in the state and in the word, so a
/// change within one word always changes the hash. The length is hashed too, so trailing zeros matter.
class Hash64 {
  public:
    /// Appends bytes. The result does not depend on how a stream is split into calls.
    void add(std::span<const std::byte> bytes);
    void add(std::string_view text) { add(std::as_bytes(std::span(text))); }

    /// Appends a value's bytes, or the number of values and then their bytes. T must have no padding.
    template <typename T>
    void addValue(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(std::as_bytes(std::span<const T, 1>(&value, 1)));
    }
    template <typename T, typename Allocator>
    void addValues(const std::vector<T, Allocator>& values) {
        static_assert(std::is_trivially_copyable_v<T>);
        addValue(uint64_t{values.size()});
        add(std::as_bytes(std::span(values)));
    }

    /// The hash of all bytes so far.
    uint64_t value() const;

  private:
    void step(uint64_t word);

    uint64_t state_ = 0xCBF29CE484222325u;
    uint64_t length_ = 0;
    std::array<std::byte, 8> rest_{};  ///< the last length_ % 8 bytes
};

/// Returns sixteen hexadecimal digits.
std::string hashText(uint64_t hash);

}  // namespace limpid
