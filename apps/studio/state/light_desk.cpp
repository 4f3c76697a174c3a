#include "studio/state/light_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/framing/own_light.h"

namespace limpid::studio {
namespace {

using scene::LightControl;

bool sameLight(const LightControl& a, const LightControl& b) {
    return a.kind == b.kind && a.index == b.index && a.name == b.name;
}

}  // namespace

void LightDesk::show(const std::vector<LightControl>& loaded, const scene::SceneSource& source) {
    lights = original = loaded;
    const auto lamps =
        std::ranges::count(loaded, LightControl::Kind::Lamp, [](const LightControl& c) { return c.kind; });
    firstAdded = static_cast<int>(lamps) - static_cast<int>(source.lights.size());
    showBackground(source);
}

void LightDesk::showBackground(const scene::SceneSource& source) {
    const auto radiance = scene::parseBackground(source.background);
    hasBackground = radiance.has_value();
    if (radiance) background = *radiance;
}

void LightDesk::carry(const LightDesk& before, bool sameSky) {
    for (size_t i = 0; i < before.lights.size(); ++i) {
        if (before.lights[i] == before.original[i]) continue;
        if (!sameSky && before.lights[i].kind == LightControl::Kind::Environment) continue;
        for (size_t k = 0; k < original.size(); ++k) {
            if (sameLight(original[k], before.original[i])) lights[k] = before.lights[i];
        }
    }
}

bool LightDesk::isAdded(const LightControl& light) const {
    return light.kind == LightControl::Kind::Lamp && light.index >= firstAdded;
}

std::string LightDesk::backgroundText() const {
    return hasBackground ? fmt::format("{},{},{}", background.r, background.g, background.b) : std::string();
}

void removeLamp(int index, scene::SceneSource& source, LightDesk& desk) {
    const auto number = static_cast<size_t>(index - desk.firstAdded);
    if (index < desk.firstAdded || number >= source.lights.size()) return;
    source.lights.erase(source.lights.begin() + static_cast<std::ptrdiff_t>(number));
    for (std::vector<LightControl>* list : {&desk.lights, &desk.original}) {
        std::erase_if(*list, [&](const LightControl& light) {
            return light.kind == LightControl::Kind::Lamp && light.index == index;
        });
        for (LightControl& light : *list) {
            if (light.kind == LightControl::Kind::Lamp && light.index > index) --light.index;
        }
    }
}

std::string newLamp(bool sun, const vec3& eye, const vec3& target, float stops) {
    constexpr float wanted = 0.4f;  // radiance reflected by a white diffuse surface, after exposure
    const float irradiance = wanted * pi * std::exp2(-stops);
    if (sun) return fmt::format("sun,0.3,1,0.4,{:.3g}", irradiance);
    const float distance = glm::distance(eye, target);
    return fmt::format("point,{:.4g},{:.4g},{:.4g},{:.3g}", eye.x, eye.y, eye.z,
                       irradiance * distance * distance);
}

}  // namespace limpid::studio
