#include "cli/options/former_options.h"

#include <string>
#include <vector>

#include "base/error.h"
#include "cli/options/pipeline_options.h"

namespace limpid::cli {
namespace {

/// Returns the options that replace a value of --pipeline or --method; empty for a value that never existed.
std::string optionNow(const std::string& value) {
    if (value == "history") return "--denoiser temporal";
    for (const Integrator integrator : integrators()) {
        if (nameOf(integrator) == value) return "--integrator " + value;
    }
    return denoise::findDenoiser(value) ? "--denoiser " + value : std::string();
}

/// Refuses the option without listing it in the help text.
void refuse(CLI::App& command, const std::string& option, const std::string& optionsNow) {
    const auto fail = [option, optionsNow](const std::vector<std::string>& values) {
        const std::string value = values.empty() ? std::string() : values.front();
        const std::string now = optionNow(value);
        if (now.empty()) throw UsageError(option + " is now " + optionsNow);
        throw UsageError(option + " " + value + " is now " + now);
    };
    command.add_option_function<std::vector<std::string>>(option, fail)->allow_extra_args(false)->group("");
}

}  // namespace

void refusePipelineOption(CLI::App& command) {
    refuse(command, "--pipeline",
           "--integrator (what is computed) and --denoiser (what cleans it: " + listOfDenoisers() + ")");
}

void refuseMethodOption(CLI::App& command) {
    refuse(command, "--method", "--denoiser, one of " + listOfDenoisers());
}

}  // namespace limpid::cli
