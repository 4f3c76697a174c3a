#include "scene/lights/light_control.h"

#include <fmt/format.h>

#include <set>

namespace limpid::scene {
namespace {

/// Returns the emissive materials that at least one triangle uses.
std::set<int> emittersOf(const Scene& scene) {
    std::set<int> used;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        if (mesh.materialSlots.empty()) used.insert(instance.material);
        for (const uint16_t slot : mesh.materialSlots) used.insert(instance.material + slot);
    }
    std::erase_if(used,
                  [&](int material) { return !isEmitter(scene.materials[static_cast<size_t>(material)]); });
    return used;
}

const char* kindName(PunctualLight::Kind kind) {
    switch (kind) {
        case PunctualLight::Kind::Point:
            return "point light";
        case PunctualLight::Kind::Spot:
            return "spot light";
        default:
            return "sun";
    }
}

LightControl controlOf(const PunctualLight& light, int index) {
    LightControl control;
    control.index = index;
    control.name = light.name.empty() ? fmt::format("{} {}", kindName(light.kind), index) : light.name;
    control.color = light.intensity;
    control.lamp = light.kind;
    control.position = light.position;
    control.direction = light.direction;
    return control;
}

void apply(Scene& scene, const LightControl& control, const LightControl& before) {
    const vec3 power = control.on ? control.color * control.brightness : vec3(0.0f);
    if (control.kind == LightControl::Kind::Environment) {
        scene.environment.scale = power;
        scene.environment.turn = control.turn / 360.0f;
    } else if (control.kind == LightControl::Kind::Emitter) {
        Material& material = scene.materials[static_cast<size_t>(control.index)];
        material.emission = power;
        material.staysEmitter = true;
    } else {
        PunctualLight& light = scene.lights[static_cast<size_t>(control.index)];
        light.intensity = power;
        if (control.position == before.position && control.direction == before.direction) return;
        light.position = control.position;
        light.direction = control.direction;
        light.node = none;
    }
}

}  // namespace

std::vector<LightControl> lightControlsOf(const Scene& scene) {
    std::vector<LightControl> controls;
    for (size_t i = 0; i < scene.lights.size(); ++i)
        controls.push_back(controlOf(scene.lights[i], static_cast<int>(i)));
    for (const int index : emittersOf(scene)) {
        const Material& material = scene.materials[static_cast<size_t>(index)];
        LightControl control;
        control.kind = LightControl::Kind::Emitter;
        control.index = index;
        control.name = material.name.empty() ? fmt::format("material {}", index) : material.name;
        control.color = material.emission;
        controls.push_back(control);
    }
    if (!scene.environment.empty()) {
        LightControl control;
        control.kind = LightControl::Kind::Environment;
        control.name = "environment";
        control.color = scene.environment.scale;
        control.turn = 360.0f * scene.environment.turn;
        controls.push_back(control);
    }
    return controls;
}

void applyLightControls(Scene& scene, std::span<const LightControl> controls,
                        std::span<const LightControl> before) {
    for (size_t i = 0; i < controls.size() && i < before.size(); ++i) {
        if (controls[i] != before[i]) apply(scene, controls[i], before[i]);
    }
}

}  // namespace limpid::scene
