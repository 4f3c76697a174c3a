#include "scene/lights/live_lights.h"

#include <algorithm>

#include "scene/device/pack.h"
#include "scene/lights/light_control.h"

namespace limpid::scene {
namespace {

/// Merges the frame's own writes to the buffer into ours, since uploads of one frame must not overlap.
void addWhole(SceneFrame& frame, std::string_view buffer, std::span<const std::byte> values) {
    if (values.empty()) return;
    std::vector<std::byte> whole(values.begin(), values.end());
    std::erase_if(frame.uploads, [&](const SceneFrame::Upload& upload) {
        if (upload.buffer != buffer) return false;
        std::ranges::copy(upload.bytes, whole.begin() + static_cast<std::ptrdiff_t>(upload.offset));
        return true;
    });
    frame.uploads.push_back({buffer, 0, std::move(whole)});
}

}  // namespace

LiveLights::LiveLights(const Scene& scene, const SceneData& data) {
    packed_.instances = data.instances;
    packed_.params = data.params;
    packed_.features.lightTree = data.features.lightTree;
    for (const LightControl& control : lightControlsOf(scene)) {
        if (control.kind == LightControl::Kind::Emitter) emitters_.push_back(control.index);
    }
}

void LiveLights::update(const Scene& scene) {
    SceneData fresh;
    fresh.instances = std::move(packed_.instances);
    fresh.params = packed_.params;
    packLamps(scene, fresh, packed_.features.lightTree);
    packed_ = std::move(fresh);
    emissions_.clear();
    for (const int emitter : emitters_)
        emissions_.push_back(scene.materials[static_cast<size_t>(emitter)].emission);
    if (!scene.environment.empty()) setEnvironmentParams(scene.environment, packed_.params);
}

void LiveLights::addTo(SceneFrame& frame) const {
    addWhole(frame, "lights", std::as_bytes(std::span(packed_.lights)));
    addWhole(frame, "lightPyramid", std::as_bytes(std::span(packed_.lightPyramid)));
    addWhole(frame, "lightTree", std::as_bytes(std::span(packed_.lightTree)));
    addWhole(frame, "lightDensity", std::as_bytes(std::span(packed_.lightDensity)));
    for (size_t i = 0; i < emissions_.size(); ++i) {
        const uint64_t record = static_cast<uint64_t>(emitters_[i]) * layout::MATERIAL_TEXELS;
        const auto bytes = std::as_bytes(std::span(&emissions_[i], 1));
        frame.uploads.push_back({"materials", (record + 1) * sizeof(uvec4), {bytes.begin(), bytes.end()}});
    }
}

void LiveLights::setParams(layout::SceneParams& params) const {
    params.environmentScale = packed_.params.environmentScale;
    params.environmentTurn = packed_.params.environmentTurn;
    params.environmentProbability = packed_.params.environmentProbability;
    params.triangleLightProbability = packed_.params.triangleLightProbability;
}

}  // namespace limpid::scene
