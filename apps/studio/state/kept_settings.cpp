#include "studio/state/kept_settings.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/files/file.h"
#include "base/log.h"
#include "renderer/method/parameters.h"

namespace limpid::studio {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void restore(const json& kept, StudioSettings& settings) {
    settings.render.pipeline =
        parsePipeline(kept.at("integrator").get<std::string>(), kept.at("denoiser").get<std::string>());
    settings.samples = std::clamp(kept.at("samples").get<uint32_t>(), 1u, 64u);
    settings.maxSamples = std::max<uint64_t>(kept.at("max_samples").get<uint64_t>(), 1);
    settings.resolution = static_cast<Resolution>(std::clamp(kept.at("shrink").get<int>(), -1, 3) + 1);
    for (const json& text : kept.at("parameters")) assign(settings.render, text.get<std::string>());
}

}  // namespace

fs::path keptSettingsFile() {
    const char* const configuration = std::getenv("XDG_CONFIG_HOME");
    if (configuration && *configuration) return fs::path(configuration) / "limpid" / "view.json";
    const char* const home = std::getenv("HOME");
    return home && *home ? fs::path(home) / ".config" / "limpid" / "view.json" : fs::path();
}

void restoreSettings(const fs::path& file, StudioSettings& settings) {
    std::error_code none;
    if (file.empty() || !fs::exists(file, none)) return;
    if (const auto fault = irregularity(file))
        return log::warn("{}: {}; it is left out", file.string(), *fault);
    try {
        std::ifstream stream(file);
        restore(json::parse(stream), settings);
    } catch (const std::exception& fault) {
        log::warn("{}: {}; the rest of it is left out", file.string(), fault.what());
    }
}

StudioSettings settingsOf(const State& state, StudioSettings settings) {
    settings.render = state.render;
    settings.preview = state.isPreview();
    if (settings.preview) settings.render.pipeline = state.pipelineBefore;
    settings.render.extent = state.viewport;
    settings.samples = state.samples;
    settings.maxSamples = static_cast<uint64_t>(state.maxSamples);
    settings.resolution = state.resolution;
    return settings;
}

void keepSettings(const fs::path& file, const StudioSettings& settings) {
    if (file.empty()) return;
    makeFolder(fs::absolute(file).parent_path());
    const json kept{{"integrator", nameOf(settings.render.pipeline.integrator)},
                    {"denoiser", nameOf(settings.render.pipeline.denoiser)},
                    {"samples", settings.samples},
                    {"max_samples", settings.maxSamples},
                    {"shrink", static_cast<int>(settings.resolution) - 1},
                    {"parameters", assignmentsOf(settings.render)}};
    writeTextAtomically(file, kept.dump(1) + "\n");
}

}  // namespace limpid::studio
