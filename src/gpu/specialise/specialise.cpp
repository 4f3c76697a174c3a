#include "gpu/specialise/specialise.h"

#include <unordered_map>

#if LIMPID_HAVE_SPIRV_TOOLS_OPT
#include <spirv-tools/optimizer.hpp>
#endif

namespace limpid::gpu {

#if LIMPID_HAVE_SPIRV_TOOLS_OPT

namespace {

/// None of these passes changes what a shader computes. Dead branches and functions are removed twice: first
/// those that constants of the module decide, then those that constants decide which are parameters or
/// variables of functions.
void addPasses(spvtools::Optimizer& optimizer,
               const std::unordered_map<uint32_t, std::vector<uint32_t>>& values) {
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass());
    for (const bool again : {false, true}) {
        if (again) optimizer.RegisterPass(spvtools::CreateCCPPass());
        optimizer.RegisterPass(spvtools::CreateDeadBranchElimPass())
            .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
            .RegisterPass(spvtools::CreateAggressiveDCEPass());
    }
}

std::vector<uint32_t> specialise(std::span<const uint32_t> words, const SpecialisationConstants& constants) {
    std::unordered_map<uint32_t, std::vector<uint32_t>> values;
    for (const auto& [id, value] : constants) values[id] = {value};
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    addPasses(optimizer, values);
    spvtools::OptimizerOptions options;
    options.set_run_validator(false);  // Embedded shaders were validated when they were compiled.
    std::vector<uint32_t> result;
    if (!optimizer.Run(words.data(), words.size(), &result, options)) result.clear();
    return result;
}

}  // namespace

Specialise specialiser() {
    return specialise;
}

#else

Specialise specialiser() {
    return {};
}

#endif

}  // namespace limpid::gpu
