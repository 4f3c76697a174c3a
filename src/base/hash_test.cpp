#include "base/hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace limpid {
namespace {

uint64_t hashOf(std::span<const std::byte> bytes) {
    Hash64 hash;
    hash.add(bytes);
    return hash.value();
}

std::vector<std::byte> randomBytes(size_t count) {
    std::mt19937 random(5);
    std::vector<std::byte> bytes(count);
    for (std::byte& b : bytes) b = static_cast<std::byte>(random() & 255u);
    return bytes;
}

TEST(Hash64, CountsOnlyTheBytesNotHowTheyCome) {
    const std::vector<std::byte> bytes = randomBytes(100);
    const uint64_t whole = hashOf(bytes);
    for (size_t piece = 1; piece <= 33; ++piece) {
        Hash64 hash;
        for (size_t at = 0; at < bytes.size(); at += piece)
            hash.add(std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)));
        EXPECT_EQ(hash.value(), whole) << piece;
    }
}

TEST(Hash64, IsTheDocumentedFormula) {
    // Computed by hand: state, then (state ^ word) * prime, then state ^ (state >> 32), for "12345678", 0 and
    // 8.
    const auto step = [](uint64_t state, uint64_t word) {
        state = (state ^ word) * 1099511628211u;
        return state ^ (state >> 32);
    };
    const uint64_t expected = step(step(step(14695981039346656037u, 0x3837363534333231u), 0), 8);
    Hash64 hash;
    hash.add(std::string_view("12345678"));
    EXPECT_EQ(hash.value(), expected);
    EXPECT_EQ(hashText(255), "00000000000000ff");
}

TEST(Hash64, EveryFlippedBitShows) {
    std::vector<std::byte> bytes = randomBytes(61);
    const uint64_t whole = hashOf(bytes);
    for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        bytes[bit / 8] ^= std::byte{1} << (bit % 8);
        EXPECT_NE(hashOf(bytes), whole) << bit;
        bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    }
}

TEST(Hash64, PairsOfFlippedBitsShow) {
    // Plain FNV over words never propagates a word's highest bit: two of them would cancel.
    std::vector<std::byte> bytes(64);
    std::set<uint64_t> seen;
    for (size_t a = 7; a < 64; a += 8) {
        for (size_t b = a + 8; b < 64; b += 8) {
            bytes[a] = bytes[b] = std::byte{0x80};
            EXPECT_TRUE(seen.insert(hashOf(bytes)).second) << a << " " << b;
            bytes[a] = bytes[b] = std::byte{0};
        }
    }
}

TEST(Hash64, LengthAndOrderCount) {
    std::set<uint64_t> seen;
    for (size_t zeros = 0; zeros < 40; ++zeros) {
        EXPECT_TRUE(seen.insert(hashOf(std::vector<std::byte>(zeros))).second) << zeros;
    }
    Hash64 ab, ba;
    ab.addValue(uint64_t{1});
    ab.addValue(uint64_t{2});
    ba.addValue(uint64_t{2});
    ba.addValue(uint64_t{1});
    EXPECT_NE(ab.value(), ba.value());
}

}  // namespace
}  // namespace limpid
