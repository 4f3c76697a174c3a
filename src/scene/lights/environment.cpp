#include "scene/lights/environment.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/io/environment_image.h"

namespace limpid::scene {
namespace {

vec3 skyRadiance(float up) {
    constexpr vec3 horizon(1.0f);
    constexpr vec3 zenith(0.45f, 0.65f, 1.0f);
    constexpr vec3 ground(0.3f, 0.28f, 0.26f);
    if (up >= 0.0f) return glm::mix(horizon, zenith, std::sqrt(up));
    // A short blend at the horizon avoids a hard edge.
    return glm::mix(horizon, ground, std::min(-up * 8.0f, 1.0f));
}

}  // namespace

Environment loadEnvironment(const std::filesystem::path& path, uint64_t maxMemory) {
    const image::Image picture = image::readEnvironmentImage(path, maxMemory);
    if (picture.components < 3 || picture.width == 0 || picture.height == 0) {
        throw InputError(path, "is no colour picture, which an environment must be");
    }
    Environment environment;
    environment.width = picture.width;
    environment.height = picture.height;
    environment.radiance.resize(size_t{picture.width} * picture.height);
    for (size_t i = 0; i < environment.radiance.size(); ++i) {
        const float* pixel = &picture.pixels[i * picture.components];
        environment.radiance[i] = {pixel[0], pixel[1], pixel[2]};
    }
    return environment;
}

Environment softSky() {
    Environment environment{64, 32, {}};
    for (uint32_t y = 0; y < environment.height; ++y) {
        const float up =
            std::cos(pi * (static_cast<float>(y) + 0.5f) / static_cast<float>(environment.height));
        environment.radiance.insert(environment.radiance.end(), environment.width, skyRadiance(up));
    }
    return environment;
}

vec2 directionToUv(const vec3& d) {
    return {std::atan2(d.x, -d.z) / (2.0f * pi) + 0.5f, std::acos(std::clamp(d.y, -1.0f, 1.0f)) / pi};
}

vec3 uvToDirection(const vec2& uv) {
    const float phi = (uv.x - 0.5f) * 2.0f * pi;
    const float theta = uv.y * pi;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

}  // namespace limpid::scene
