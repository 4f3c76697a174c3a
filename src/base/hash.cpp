#include "base/hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace limpid {
namespace {

static_assert(std::endian::native == std::endian::little, "words are hashed as they lie in memory");

uint64_t wordAt(const std::byte* bytes) {
    uint64_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

}  // namespace

void Hash64::step(uint64_t word) {
    constexpr uint64_t prime = 0x100000001B3u;
    state_ = (state_ ^ word) * prime;
    state_ ^= state_ >> 32;
}

void Hash64::add(std::span<const std::byte> bytes) {
    const size_t pending = length_ % 8;
    length_ += bytes.size();
    if (pending > 0) {
        const size_t taken = std::min(bytes.size(), 8 - pending);
        std::copy_n(bytes.begin(), taken, rest_.begin() + static_cast<std::ptrdiff_t>(pending));
        if (pending + taken < 8) return;
        step(wordAt(rest_.data()));
        bytes = bytes.subspan(taken);
    }
    for (; bytes.size() >= 8; bytes = bytes.subspan(8)) step(wordAt(bytes.data()));
    std::copy(bytes.begin(), bytes.end(), rest_.begin());
}

uint64_t Hash64::value() const {
    Hash64 ended = *this;
    std::fill(ended.rest_.begin() + static_cast<std::ptrdiff_t>(length_ % 8), ended.rest_.end(),
              std::byte{0});
    ended.step(wordAt(ended.rest_.data()));
    ended.step(length_);
    return ended.state_;
}

std::string hashText(uint64_t hash) {
    return fmt::format("{:016x}", hash);
}

}  // namespace limpid
