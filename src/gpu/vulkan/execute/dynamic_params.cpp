#include "gpu/vulkan/execute/dynamic_params.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace limpid::gpu {
namespace {

using Words = std::span<const uint32_t>;

constexpr uint32_t magic = 0x07230203;
constexpr size_t headerWords = 5, boundWord = 3;

// SPIR-V specification, chapter 3.
enum Op : uint32_t {
    OpEntryPoint = 15,
    OpCapability = 17,
    OpTypeVoid = 19,
    OpTypeBool = 20,
    OpTypeInt = 21,
    OpTypeVector = 23,
    OpTypeArray = 28,
    OpTypePointer = 32,
    OpTypePipe = 38,
    OpConstant = 43,
    OpFunction = 54,
    OpVariable = 59,
    OpLoad = 61,
    OpAccessChain = 65,
    OpInBoundsAccessChain = 66,
    OpDecorate = 71,
    OpCompositeExtract = 81,
    OpSelect = 169,
    OpIEqual = 170,
    OpLabel = 248
};
enum : uint32_t {
    ModelCompute = 5,
    StorageInput = 1,
    StorageUniform = 2,
    CapabilityUniformBufferArrayDynamicIndexing = 28,
    DecorationBuiltIn = 11,
    BuiltInNumWorkgroups = 24
};

Op opOf(Words instruction) {
    return static_cast<Op>(instruction[0] & 0xFFFFu);
}

/// Words of an instruction that we read.
size_t leastWords(Op op) {
    switch (op) {
        case OpTypeBool:
            return 2;
        case OpEntryPoint:
        case OpTypeInt:
        case OpTypeVector:
        case OpTypePointer:
        case OpVariable:
        case OpLoad:
        case OpAccessChain:
        case OpInBoundsAccessChain:
            return 4;
        default:
            return 1;
    }
}

/// The module's instructions; none if it is damaged. What is read of an instruction is there.
std::vector<Words> instructionsOf(Words words) {
    std::vector<Words> all;
    if (words.empty() || words[0] != magic) return {};
    for (size_t at = headerWords; at < words.size(); at += all.back().size()) {
        const size_t length = words[at] >> 16;
        if (length == 0 || length > words.size() - at) return {};
        all.push_back(words.subspan(at, length));
        if (length < leastWords(opOf(all.back()))) return {};
    }
    return all;
}

/// Ids of what the module declares already, which must not be declared twice; 0: not there.
struct Declared {
    uint32_t block = 0, blockPointer = 0, blockType = 0, blocks = 0;  ///< the last: their number
    uint32_t boolType = 0, uintType = 0, uint3Type = 0, uint3Pointer = 0, workgroups = 0;
    bool isCompute = false;

    explicit Declared(std::span<const Words> instructions) {
        for (const Words i : instructions) note(i);
        for (const Words i : instructions)
            if (opOf(i) == OpTypePointer && i[1] == blockPointer) blockType = i[3];
    }

    bool canChange() const { return isCompute && blocks == 1 && blockType != 0; }

  private:
    void note(Words i) {
        const Op op = opOf(i);
        if (op == OpEntryPoint) isCompute = i[1] == ModelCompute;
        if (op == OpTypeBool) boolType = i[1];
        if (op == OpTypeInt && i[2] == 32 && i[3] == 0) uintType = i[1];
        if (op == OpTypeVector && uintType != 0 && i[2] == uintType && i[3] == 3) uint3Type = i[1];
        if (op == OpTypePointer && i[2] == StorageInput && uint3Type != 0 && i[3] == uint3Type)
            uint3Pointer = i[1];
        if (op == OpDecorate && i.size() > 3 && i[2] == DecorationBuiltIn && i[3] == BuiltInNumWorkgroups)
            workgroups = i[1];
        if (op == OpVariable && i[3] == StorageUniform) {
            blockPointer = i[1];
            block = i[2];
            ++blocks;
        }
    }
};

class Rewriting {
  public:
    Rewriting(Words words, std::span<const Words> instructions)
        : instructions_(instructions), declared_(instructions) {
        result_.assign(words.begin(), words.begin() + headerWords);
        result_.reserve(words.size() + 128);
    }

    bool isNeeded() const { return declared_.canChange(); }

    std::vector<uint32_t> run() {
        addsWorkgroups_ = declared_.workgroups == 0;
        if (addsWorkgroups_) declared_.workgroups = newId();
        for (const Words i : instructions_) {
            const Op op = opOf(i);
            if (op != OpCapability && section_ == Section::Capabilities) endCapabilities();
            if (op >= OpTypeVoid && op <= OpTypePipe && section_ == Section::Annotations) endAnnotations();
            if (op == OpFunction && section_ == Section::Types) endTypes();
            if (op == OpFunction) index_ = 0;
            if (section_ == Section::Functions)
                copyCode(op, i);
            else
                copyDeclaration(op, i);
        }
        return std::move(result_);
    }

  private:
    enum class Section { Capabilities, Annotations, Types, Functions };

    uint32_t newId() { return result_[boundWord]++; }

    void add(Op op, std::initializer_list<uint32_t> operands) {
        result_.push_back(static_cast<uint32_t>(operands.size() + 1) << 16 | op);
        result_.insert(result_.end(), operands);
    }
    void copy(Words instruction) { result_.insert(result_.end(), instruction.begin(), instruction.end()); }
    /// A copy with one more operand.
    void copyWith(Words instruction, size_t at, uint32_t operand) {
        const auto place = instruction.begin() + static_cast<std::ptrdiff_t>(at);
        result_.push_back(instruction[0] + (1u << 16));
        result_.insert(result_.end(), instruction.begin() + 1, place);
        result_.push_back(operand);
        result_.insert(result_.end(), place, instruction.end());
    }

    void endCapabilities() {
        add(OpCapability, {CapabilityUniformBufferArrayDynamicIndexing});
        section_ = Section::Annotations;
    }
    void endAnnotations() {
        if (addsWorkgroups_) add(OpDecorate, {declared_.workgroups, DecorationBuiltIn, BuiltInNumWorkgroups});
        section_ = Section::Types;
    }
    /// What the module lacks, and the block, whose declaration was left out.
    void endTypes() {
        const auto declare = [&](uint32_t& id, Op op, std::initializer_list<uint32_t> operands) {
            if (id != 0) return;
            id = newId();
            result_.push_back(static_cast<uint32_t>(operands.size() + 2) << 16 | op);
            result_.push_back(id);
            result_.insert(result_.end(), operands);
        };
        declare(declared_.boolType, OpTypeBool, {});
        declare(declared_.uintType, OpTypeInt, {32, 0});
        declare(declared_.uint3Type, OpTypeVector, {declared_.uintType, 3});
        if (addsWorkgroups_) {
            declare(declared_.uint3Pointer, OpTypePointer, {StorageInput, declared_.uint3Type});
            add(OpVariable, {declared_.uint3Pointer, declared_.workgroups, StorageInput});
        }
        add(OpConstant, {declared_.uintType, zero_ = newId(), 0});
        add(OpConstant, {declared_.uintType, one_ = newId(), 1});
        uint32_t array = 0, pointer = 0;
        declare(array, OpTypeArray, {declared_.blockType, one_});
        declare(pointer, OpTypePointer, {StorageUniform, array});
        add(OpVariable, {pointer, declared_.block, StorageUniform});
        section_ = Section::Functions;
    }

    void copyDeclaration(Op op, Words i) {
        if (op == OpEntryPoint && addsWorkgroups_) return copyWith(i, i.size(), declared_.workgroups);
        if (op == OpVariable && i[2] == declared_.block) return;
        copy(i);
    }

    void copyCode(Op op, Words i) {
        // The variables of a function come first in its first block.
        if (op == OpLabel && index_ == 0) {
            copy(i);
            inFirstBlock_ = true;
            return;
        }
        if (std::exchange(inFirstBlock_, inFirstBlock_ && op == OpVariable) && op != OpVariable) addIndex();
        if ((op == OpAccessChain || op == OpInBoundsAccessChain) && i[3] == declared_.block)
            return copyWith(i, 4, index_);
        if (op == OpLoad && i[3] == declared_.block) {
            const uint32_t whole = newId();
            add(OpAccessChain, {declared_.blockPointer, whole, declared_.block, index_});
            result_.insert(result_.end(), {i[0], i[1], i[2], whole});
            result_.insert(result_.end(), i.begin() + 4, i.end());
            return;
        }
        copy(i);
    }

    /// 0, since there is a workgroup.
    void addIndex() {
        const uint32_t counts = newId(), count = newId(), isNone = newId();
        add(OpLoad, {declared_.uint3Type, counts, declared_.workgroups});
        add(OpCompositeExtract, {declared_.uintType, count, counts, 0});
        add(OpIEqual, {declared_.boolType, isNone, count, zero_});
        add(OpSelect, {declared_.uintType, index_ = newId(), isNone, one_, zero_});
    }

    std::span<const Words> instructions_;
    Declared declared_;
    std::vector<uint32_t> result_;
    Section section_ = Section::Capabilities;
    bool addsWorkgroups_ = false, inFirstBlock_ = false;
    uint32_t zero_ = 0, one_ = 0;
    uint32_t index_ = 0;  ///< of the function; 0: it has not begun
};

}  // namespace

std::vector<uint32_t> withDynamicParams(Words words) {
    const std::vector<Words> instructions = instructionsOf(words);
    if (!instructions.empty())
        if (Rewriting rewriting(words, instructions); rewriting.isNeeded()) return rewriting.run();
    return {words.begin(), words.end()};
}

}  // namespace limpid::gpu
