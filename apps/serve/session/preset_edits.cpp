#include "serve/session/preset_edits.h"

#include <algorithm>
#include <set>
#include <string>

#include "renderer/method/presets.h"
#include "studio/state/state_json.h"

namespace limpid::serve {
namespace {

using nlohmann::json;

std::set<std::string> presetFields() {
    std::set<std::string> keys{"integrator", "denoiser", "jitter"};
    for (const Preset& preset : presets()) {
        for (const std::string& text : preset.assignments) keys.insert(text.substr(0, text.find('=')));
    }
    return keys;
}

/// The default one first.
std::vector<Pipeline> pipelinesOf(const Preset& preset) {
    std::vector<Pipeline> all;
    for (const std::string& integrator : preset.integrators) {
        for (const std::string& denoiser : preset.denoisers) {
            if (denoiser == "none" || canBeDenoised(parseIntegrator(integrator)))
                all.push_back(parsePipeline(integrator, denoiser));
        }
    }
    return all;
}

json changesOf(const Preset& preset, const std::vector<Pipeline>& pipelines) {
    studio::State state;
    state.render.pipeline = preset.pipeline();
    applyOnlyPreset(state.render, preset.name);
    // By name, unless it is what each of its pipelines needs anyway.
    const auto isDefault = [&](const Pipeline& p) { return defaultJitter(p) == preset.jitter; };
    state.jitter = std::ranges::all_of(pipelines, isDefault) ? 0 : 1 + static_cast<int>(preset.jitter);
    const json all = studio::toJson(state);
    json changes = json::object();
    for (const std::string& key : presetFields()) changes[key] = all.at(key);
    return changes;
}

}  // namespace

json presetEdits() {
    json list = json::array();
    for (const Preset& preset : presets()) {
        const std::vector<Pipeline> pipelines = pipelinesOf(preset);
        json names = json::array();
        for (const Pipeline& pipeline : pipelines)
            names.push_back(std::string(nameOf(pipeline.integrator)) + "+" +
                            std::string(nameOf(pipeline.denoiser)));
        list.push_back({{"name", preset.name},
                        {"help", preset.help},
                        {"pipelines", std::move(names)},
                        {"changes", changesOf(preset, pipelines)}});
    }
    return list;
}

}  // namespace limpid::serve
