#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "scratch.h"

namespace limpid::fuzz {
namespace {

bool isGlb(Bytes input) {
    return input.size() >= 4 && std::memcmp(input.data(), "glTF", 4) == 0;
}

void append(std::vector<std::byte>& target, Bytes bytes) {
    target.insert(target.end(), bytes.begin(), bytes.end());
}

void appendWords(std::vector<std::byte>& target, std::array<uint32_t, 2> words) {
    append(target, std::as_bytes(std::span(words)));
}

/// Adds a valid GLB header, so that the fuzzer need not guess the lengths. (Words are little-endian, like the
/// machines used for fuzzing.)
std::vector<std::byte> toGlb(const Parts& parts) {
    const auto size = [](Bytes bytes) { return static_cast<uint32_t>(bytes.size()); };
    std::vector<std::byte> glb;
    append(glb, std::as_bytes(std::span("glTF", 4)));
    appendWords(glb, {2, 28 + size(parts.first) + size(parts.second)});
    appendWords(glb, {size(parts.first), 0x4E4F534A});
    append(glb, parts.first);
    appendWords(glb, {size(parts.second), 0x004E4942});
    append(glb, parts.second);
    return glb;
}

}  // namespace

bool gltf(Bytes input) {
    const Parts parts = splitAtZero(input);
    if (isGlb(input) || !parts.split) return reachesDevice(scratch().write("scene.gltf", input));
    scratch().write("scene.bin", parts.second);
    const bool reached = reachesDevice(scratch().write("scene.glb", toGlb(parts)));
    scratch().remove("scene.bin");
    return reached;
}

}  // namespace limpid::fuzz
