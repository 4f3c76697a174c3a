#include "cli/options/pipeline_options.h"

#include <fmt/ranges.h>

#include "cli/options/former_options.h"

namespace limpid::cli {

std::string listOfDenoisers() {
    return fmt::format("{}", fmt::join(denoiserNames(), ", "));
}

void addPipelineOptions(CLI::App& command, PipelineChoice& choice, const std::string& defaultIntegrator,
                        const std::string& defaultDenoiser) {
    std::vector<std::string_view> names;
    for (const Integrator integrator : integrators()) names.push_back(nameOf(integrator));
    command.add_option(
        "--integrator", choice.integrator,
        fmt::format("Integrator, what is computed: {} ({})", fmt::join(names, ", "), defaultIntegrator));
    command.add_option("--denoiser", choice.denoiser,
                       fmt::format("Denoiser, what cleans it: {} ({})", listOfDenoisers(), defaultDenoiser));
    refusePipelineOption(command);
}

}  // namespace limpid::cli
