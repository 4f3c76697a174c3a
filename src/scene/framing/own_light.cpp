#include "scene/framing/own_light.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>
#include <vector>

#include "base/error.h"

namespace limpid::scene {
namespace {

/// Parses numbers separated by commas; returns nothing if the text is anything else.
std::vector<float> numbers(const std::string& text) {
    std::vector<float> result;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) {
        float value = 0.0f;
        const auto [end, fault] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (fault != std::errc() || end != part.data() + part.size() || !std::isfinite(value)) return {};
        result.push_back(value);
    }
    return result;
}

}  // namespace

std::optional<PunctualLight> parseLamp(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const size_t comma = text.find(',');
    const std::string kind = text.substr(0, comma);
    const std::vector<float> values =
        comma == std::string::npos ? std::vector<float>() : numbers(text.substr(comma + 1));
    if ((kind != "point" && kind != "sun") || values.size() != 4 || values[3] < 0.0f)
        throw UsageError("a light is point,X,Y,Z,INTENSITY or sun,X,Y,Z,INTENSITY, not '" + text + "'");
    PunctualLight lamp;
    const vec3 at(values[0], values[1], values[2]);
    lamp.intensity = vec3(values[3]);
    lamp.name = "own light";
    if (kind == "point") {
        lamp.position = at;
        return lamp;
    }
    if (glm::length(at) == 0.0f) throw UsageError("a sun at 0,0,0 shines from nowhere");
    lamp.kind = PunctualLight::Kind::Directional;
    lamp.direction = -glm::normalize(at);
    return lamp;
}

std::optional<vec3> parseBackground(const std::string& text) {
    if (text.empty()) return std::nullopt;
    const std::vector<float> values = numbers(text);
    if (values.size() != 3 || values[0] < 0.0f || values[1] < 0.0f || values[2] < 0.0f)
        throw UsageError("a background is R,G,B, none below 0, not '" + text + "'");
    return vec3(values[0], values[1], values[2]);
}

void addOwnLight(Scene& scene, const OwnLight& light) {
    scene.lights.insert(scene.lights.end(), light.lamps.begin(), light.lamps.end());
    if (!light.background) return;
    scene.environment = {};
    if (*light.background == vec3(0.0f)) return;
    scene.environment.width = 4;
    scene.environment.height = 2;
    scene.environment.radiance.assign(8, *light.background);
}

}  // namespace limpid::scene
