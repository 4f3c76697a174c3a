#include "light_choice.h"

#include <fmt/format.h>

#include "scene/own_light.h"

namespace limpid::viewer {

std::string LightChoice::lamp() const {
    if (kind == 0) return {};
    return fmt::format("{},{},{},{},{}", kind == 1 ? "point" : "sun", at.x, at.y, at.z, intensity);
}

std::string LightChoice::backgroundText() const {
    return hasBackground ? fmt::format("{},{},{}", background.r, background.g, background.b) : std::string();
}

LightChoice lightChoiceOf(const std::string& lamp, const std::string& background) {
    LightChoice choice;
    if (const auto light = scene::parseLamp(lamp)) {
        const bool isPoint = light->kind == scene::PunctualLight::Kind::Point;
        choice.kind = isPoint ? 1 : 2;
        choice.at = isPoint ? light->position : -light->direction;
        choice.intensity = light->intensity.x;
    }
    if (const auto radiance = scene::parseBackground(background)) {
        choice.hasBackground = true;
        choice.background = *radiance;
    }
    return choice;
}

}  // namespace limpid::viewer
