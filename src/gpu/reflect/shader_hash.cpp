#include "gpu/reflect/shader_hash.h"

#include <string_view>

namespace limpid::gpu {
namespace {

class Fnv1a {
  public:
    void add(uint8_t byte) { state_ = (state_ ^ byte) * 0x100000001B3u; }
    /// Little-endian on every machine.
    void add(uint32_t word) {
        for (int shift = 0; shift < 32; shift += 8) add(static_cast<uint8_t>(word >> shift));
    }
    void add(std::string_view text) {
        add(static_cast<uint32_t>(text.size()));
        for (const char c : text) add(static_cast<uint8_t>(c));
    }
    void add(const ShaderBinding& binding) {
        add(binding.name);
        add(binding.binding);
        add(static_cast<uint32_t>(binding.kind));
        add(static_cast<uint32_t>(binding.format));
        add(uint32_t{binding.readable} << 1 | uint32_t{binding.writable});
        add(binding.blockSize);
    }
    uint64_t value() const { return state_; }

  private:
    uint64_t state_ = 0xCBF29CE484222325u;
};

}  // namespace

uint64_t hashOf(std::span<const uint32_t> words, const ShaderReflection& reflection) {
    Fnv1a hash;
    hash.add(static_cast<uint32_t>(words.size()));
    for (const uint32_t word : words) hash.add(word);
    hash.add(static_cast<uint32_t>(reflection.stage));
    hash.add(static_cast<uint32_t>(reflection.bindings.size()));
    for (const ShaderBinding& binding : reflection.bindings) hash.add(binding);
    hash.add(static_cast<uint32_t>(reflection.constants.size()));
    for (const ShaderConstant& constant : reflection.constants) {
        hash.add(constant.name);
        hash.add(constant.id);
    }
    for (const uint32_t size : reflection.workgroupSize) hash.add(size);
    for (const uint32_t id : reflection.workgroupSizeIds) hash.add(id);
    return hash.value();
}

}  // namespace limpid::gpu
