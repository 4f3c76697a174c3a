// Validates SPIR-V as Limpid's shaders use it. Only with LIMPID_HAVE_SPIRV_TOOLS_OPT.
#pragma once

#include <cstdint>
#include <spirv-tools/libspirv.hpp>
#include <string>
#include <vector>

namespace limpid::test {

class SpirvValidator {
  public:
    SpirvValidator() {
        tools_.SetMessageConsumer([this](spv_message_level_t, const char*, const spv_position_t&,
                                         const char* text) { fault_ = text; });
        options_.SetScalarBlockLayout(true);
    }
    SpirvValidator(const SpirvValidator&) = delete;
    SpirvValidator& operator=(const SpirvValidator&) = delete;

    bool accepts(const std::vector<uint32_t>& words) {
        return tools_.Validate(words.data(), words.size(), options_);
    }
    /// Of the last module that was not accepted.
    const std::string& fault() const { return fault_; }

  private:
    spvtools::SpirvTools tools_{SPV_ENV_VULKAN_1_3};
    spvtools::ValidatorOptions options_;
    std::string fault_;
};

}  // namespace limpid::test
