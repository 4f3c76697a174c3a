#include "gpu/reflect/spirv_declarations.h"

#include <algorithm>
#include <set>

namespace limpid::gpu {
namespace {

// From the SPIR-V specification, "Instructions".
enum Op : uint32_t {
    OpEntryPoint = 15,
    OpTypeArray = 28,
    OpTypeStruct = 30,
    OpTypePointer = 32,
    OpTypeFunction = 33,
    OpConstantComposite = 44,
    OpConstantNull = 46,
    OpSpecConstantComposite = 51,
    OpSpecConstantOp = 52,
    OpFunction = 54,
    OpFunctionEnd = 56,
    OpVariable = 59,
    OpLabel = 248,
    OpReturn = 253,
    OpTypeCooperativeMatrixNV = 5358,
    OpCooperativeMatrixLengthNV = 5362,
};

constexpr size_t headerWords = 5;
constexpr size_t boundWord = 3;

struct Instruction {
    uint32_t op = 0;
    std::span<const uint32_t> words;  ///< including the first word, which has opcode and length
};

class Filter {
  public:
    explicit Filter(std::span<const uint32_t> words) : words_(words) {}

    std::vector<uint32_t> run() {
        if (words_.size() < headerWords || !hasMatrices()) return {words_.begin(), words_.end()};
        kept_.assign(words_.begin(), words_.begin() + headerWords);
        bool inFunction = false;
        for (size_t at = headerWords; at < words_.size();) {
            const Instruction instruction = next(at);
            if (instruction.op == OpEntryPoint && instruction.words.size() > 2) entry_ = instruction.words[2];
            if (instruction.op == OpFunction) {
                inFunction = true;
                if (instruction.words.size() > 2 && instruction.words[2] == entry_) keepEmptied(instruction);
            } else if (instruction.op == OpFunctionEnd) {
                inFunction = false;
            } else if (!inFunction && !drops(instruction)) {
                keep(instruction.words);
            }
        }
        return std::move(kept_);
    }

  private:
    /// Treats a damaged length as the module's end; the reader of the result reports it.
    Instruction next(size_t& at) const {
        const size_t length = std::clamp<size_t>(words_[at] >> 16, 1, words_.size() - at);
        const Instruction instruction{words_[at] & 0xFFFFu, words_.subspan(at, length)};
        at += length;
        return instruction;
    }

    bool hasMatrices() const {
        for (size_t at = headerWords; at < words_.size();) {
            if (next(at).op == OpTypeCooperativeMatrixNV) return true;
        }
        return false;
    }

    bool dropped(uint32_t id) const { return dropped_.contains(id); }

    /// Returns true if a declaration is a cooperative matrix or uses one, and records its id as dropped.
    bool drops(const Instruction& instruction) {
        const auto word = [&](size_t i) { return i < instruction.words.size() ? instruction.words[i] : 0; };
        const auto anyFrom = [&](size_t first) {
            return first < instruction.words.size() &&
                   std::ranges::any_of(instruction.words.subspan(first),
                                       [&](uint32_t id) { return dropped(id); });
        };
        size_t result = 1;  // the index of the result's id
        bool drop = false;
        switch (instruction.op) {
            case OpTypeCooperativeMatrixNV:
                drop = true;
                break;
            case OpTypePointer:
                drop = dropped(word(3));
                break;
            case OpTypeArray:
                drop = dropped(word(2));
                break;
            case OpTypeStruct:
            case OpTypeFunction:
                drop = anyFrom(2);
                break;
            case OpConstantComposite:
            case OpSpecConstantComposite:
            case OpConstantNull:
            case OpVariable:
                result = 2;
                drop = dropped(word(1));
                break;
            case OpSpecConstantOp:
                result = 2;
                drop = dropped(word(1)) || word(3) == OpCooperativeMatrixLengthNV || anyFrom(4);
                break;
            default:
                break;
        }
        if (drop) dropped_.insert(word(result));
        return drop;
    }

    void keep(std::span<const uint32_t> words) { kept_.insert(kept_.end(), words.begin(), words.end()); }

    void keepEmptied(const Instruction& function) {
        keep(function.words);
        const uint32_t label = kept_[boundWord]++;
        kept_.insert(kept_.end(), {2u << 16 | OpLabel, label, 1u << 16 | OpReturn, 1u << 16 | OpFunctionEnd});
    }

    std::span<const uint32_t> words_;
    std::vector<uint32_t> kept_;
    std::set<uint32_t> dropped_;
    uint32_t entry_ = 0;
};

}  // namespace

std::vector<uint32_t> withoutCooperativeMatrices(std::span<const uint32_t> words) {
    return Filter(words).run();
}

}  // namespace limpid::gpu
