#include "viewer/panel/kept_settings.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/files/file.h"
#include "base/log.h"
#include "renderer/frame/parameters.h"

namespace limpid::viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void restore(const json& kept, ViewSettings& settings) {
    settings.render.pipeline =
        parsePipeline(kept.at("integrator").get<std::string>(), kept.at("denoiser").get<std::string>());
    settings.samples = std::clamp(kept.at("samples").get<uint32_t>(), 1u, 64u);
    settings.maxSamples = std::max<uint64_t>(kept.at("max_samples").get<uint64_t>(), 1);
    settings.shrink = std::clamp(kept.at("shrink").get<int>(), -1, 3);
    for (const json& text : kept.at("parameters")) assign(settings.render, text.get<std::string>());
}

}  // namespace

fs::path keptSettingsFile() {
    const char* const configuration = std::getenv("XDG_CONFIG_HOME");
    if (configuration && *configuration) return fs::path(configuration) / "limpid" / "view.json";
    const char* const home = std::getenv("HOME");
    return home && *home ? fs::path(home) / ".config" / "limpid" / "view.json" : fs::path();
}

void restoreSettings(const fs::path& file, ViewSettings& settings) {
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

void keepSettings(const fs::path& file, const ViewSettings& settings) {
    if (file.empty()) return;
    makeFolder(fs::absolute(file).parent_path());
    const json kept{{"integrator", nameOf(settings.render.pipeline.integrator)},
                    {"denoiser", nameOf(settings.render.pipeline.denoiser)},
                    {"samples", settings.samples},
                    {"max_samples", settings.maxSamples},
                    {"shrink", settings.shrink},
                    {"parameters", assignmentsOf(settings.render)}};
    writeTextAtomically(file, kept.dump(1) + "\n");
}

}  // namespace limpid::viewer
