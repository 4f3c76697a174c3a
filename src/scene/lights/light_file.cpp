#include "scene/lights/light_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/gltf/document/gltf_json.h"
#include "scene/load/scene_files.h"

namespace limpid::scene {
namespace {

const char* const kindNames[] = {"lamp", "material", "environment"};

const char* nameOf(LightControl::Kind kind) {
    return kindNames[static_cast<size_t>(kind)];
}

nlohmann::json triple(const vec3& v) {
    return {v.x, v.y, v.z};
}

nlohmann::json entryOf(const LightControl& control) {
    nlohmann::json entry{{"kind", nameOf(control.kind)},   {"index", control.index},
                         {"name", control.name},           {"on", control.on},
                         {"color", triple(control.color)}, {"brightness", control.brightness}};
    if (control.kind == LightControl::Kind::Lamp) {
        entry["position"] = triple(control.position);
        entry["direction"] = triple(control.direction);
    }
    if (control.kind == LightControl::Kind::Environment) entry["turn"] = control.turn;
    return entry;
}

void requireKnownKeys(const gltf::Object& entry) {
    constexpr std::array known{"kind",       "index",    "name",      "on",  "color",
                               "brightness", "position", "direction", "turn"};
    for (const std::string& key : entry.keys()) {
        if (std::ranges::find(known, key) == known.end()) entry.fail(key.c_str(), "is not known");
    }
}

void read(const gltf::Object& entry, LightControl& control) {
    requireKnownKeys(entry);
    control.on = entry.boolean("on", control.on);
    control.color = entry.vector("color", control.color);
    control.brightness = entry.number("brightness", control.brightness);
    control.position = entry.vector("position", control.position);
    control.direction = entry.vector("direction", control.direction);
    control.turn = entry.number("turn", control.turn);
    if (glm::any(glm::lessThan(control.color, vec3(0.0f)))) entry.fail("color", "is below 0");
    if (control.brightness < 0.0f) entry.fail("brightness", "is below 0");
    if (glm::length(control.direction) == 0.0f) entry.fail("direction", "is zero");
    if (entry.has("direction") && std::abs(glm::length(control.direction) - 1.0f) > 1e-5f)
        control.direction = glm::normalize(control.direction);
}

}  // namespace

std::string lightFileText(std::span<const LightControl> controls, std::span<const LightControl> before) {
    nlohmann::json lights = nlohmann::json::array();
    for (size_t i = 0; i < controls.size() && i < before.size(); ++i) {
        if (controls[i] != before[i]) lights.push_back(entryOf(controls[i]));
    }
    return nlohmann::json{{"lights", lights}}.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) +
           "\n";
}

std::vector<LightControl> readLightFile(const std::filesystem::path& file, std::vector<LightControl> before) {
    const gltf::Json json = gltf::parseJson(file, readSceneFile(file));
    const gltf::Object root(file, json, "");
    for (const gltf::Object& entry : root.objects("lights")) {
        const std::string kind = entry.text("kind");
        const uint64_t index = entry.whole("index", 0);
        const auto found = std::ranges::find_if(before, [&](const LightControl& control) {
            return nameOf(control.kind) == kind && static_cast<uint64_t>(control.index) == index;
        });
        if (found == before.end()) entry.fail("is no light of the scene");
        read(entry, *found);
    }
    return before;
}

}  // namespace limpid::scene
