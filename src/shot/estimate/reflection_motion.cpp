#include "shot/estimate/reflection_motion.h"

#include <algorithm>
#include <cmath>

#include "shot/frame/pixel_layers.h"

namespace limpid::shot {
namespace {

using denoise::HostFrame;

constexpr int baseline = 3;              ///< pixels to each side over which curvature is measured
constexpr float sameSurface = 0.8f;      ///< least cosine between the normals at its ends and the pixel's
constexpr float normalRounding = 4e-3f;  ///< change of a normal that may be its error
constexpr float stillness = 0.5f;        ///< pixels: a mirror that moves further by itself is not followed

vec3 vectorAt(const std::vector<float>& texels, size_t p) {
    return {texels[4 * p], texels[4 * p + 1], texels[4 * p + 2]};
}

float sumAt(const image::Image& image, size_t p) {
    return image.pixels[3 * p] + image.pixels[3 * p + 1] + image.pixels[3 * p + 2];
}

vec2 onScreenOf(const vec2& pixel, const HostFrame& frame) {
    return {2.0f * (pixel.x + 0.5f) / static_cast<float>(frame.width) - 1.0f,
            1.0f - 2.0f * (pixel.y + 0.5f) / static_cast<float>(frame.height)};
}

vec2 pixelOf(size_t p, const HostFrame& frame) {
    return {p % frame.width, p / frame.width};
}

vec3 viewOf(const vec2& pixel, const CameraParams& camera, const HostFrame& frame) {
    return glm::normalize(rayOf(camera, onScreenOf(pixel, frame)));
}

/// Where the camera sees a point, in pixels.
std::optional<vec2> seenAt(const vec3& point, const CameraParams& camera, const HostFrame& frame) {
    const vec3 to = point - camera.origin;
    const float z = glm::dot(to, camera.forward);
    if (!(z > 0.0f)) return std::nullopt;
    const vec2 at(glm::dot(to, camera.right) / glm::dot(camera.right, camera.right),
                  glm::dot(to, camera.up) / glm::dot(camera.up, camera.up));
    return vec2((at.x / z + 1.0f) * 0.5f * static_cast<float>(frame.width) - 0.5f,
                (1.0f - at.y / z) * 0.5f * static_cast<float>(frame.height) - 0.5f);
}

/// The pixels of mirrors, as points with normals.
class Mirrors {
  public:
    explicit Mirrors(const HostFrame& frame) : frame_(frame) {}

    vec3 pointAt(size_t p) const {
        return frame_.camera.origin + viewOf(pixelOf(p, frame_), frame_.camera, frame_) * frame_.depth[4 * p];
    }

    /// 1 / radius, positive if it is convex; nothing where other surfaces lie around.
    std::optional<float> curvatureAt(size_t p) const {
        const auto x = curvatureAlong(p, 1, 0), y = curvatureAlong(p, 0, 1);
        if (!x && !y) return std::nullopt;
        return (x.value_or(y.value_or(0.0f)) + y.value_or(x.value_or(0.0f))) / 2.0f;
    }

  private:
    std::optional<float> curvatureAlong(size_t p, int dx, int dy) const {
        const auto a = neighbour(p, -baseline * dx, -baseline * dy),
                   b = neighbour(p, baseline * dx, baseline * dy);
        if (!a || !b) return std::nullopt;
        const vec3 own = vectorAt(frame_.normal, p);
        const vec3 first = vectorAt(frame_.normal, *a), second = vectorAt(frame_.normal, *b);
        if (!(glm::dot(first, own) > sameSurface && glm::dot(second, own) > sameSurface)) return std::nullopt;
        const vec3 along = pointAt(*b) - pointAt(*a), turn = second - first;
        const float size = std::max(glm::length(turn), 1e-30f);
        return glm::dot(turn, along) / std::max(glm::dot(along, along), 1e-30f) *
               std::max(1.0f - normalRounding / size, 0.0f);
    }

    std::optional<size_t> neighbour(size_t p, int dx, int dy) const {
        const int x = static_cast<int>(p % frame_.width) + dx, y = static_cast<int>(p / frame_.width) + dy;
        if (x < 0 || y < 0 || x >= static_cast<int>(frame_.width) || y >= static_cast<int>(frame_.height))
            return std::nullopt;
        const size_t q = static_cast<size_t>(y) * frame_.width + static_cast<size_t>(x);
        if (!(frame_.depth[4 * q + 1] > 0.0f) || frame_.ids[2 * q] != frame_.ids[2 * p]) return std::nullopt;
        return q;
    }

    const HostFrame& frame_;
};

/// What `distance` lacks of the distance from the eye: that of the near plane. The median over every seventh
/// pixel of diffuse surfaces, where it does not go on.
float nearDistance(const image::Image& length, const HostFrame& frame) {
    std::vector<float> lacks;
    for (size_t p = 0; p < frame.pixelCount(); p += 7) {
        const float diffuse = frame.albedo[4 * p] + frame.albedo[4 * p + 1] + frame.albedo[4 * p + 2];
        if (frame.depth[4 * p] > 0.0f && diffuse > 0.1f && std::isfinite(length.pixels[p]))
            lacks.push_back(frame.depth[4 * p] - length.pixels[p]);
    }
    if (lacks.empty()) return 0.0f;
    const auto middle = lacks.begin() + static_cast<std::ptrdiff_t>(lacks.size() / 2);
    std::nth_element(lacks.begin(), middle, lacks.end());
    return std::max(*middle, 0.0f);
}

/// True where at least this share of the specular light is not refracted.
bool reflects(const ShotLayers& layers, size_t p, float share) {
    return sumAt(*layers.find("albedoReflected"), p) > share * sumAt(*layers.find("albedoSpecular"), p);
}

/// True where a surface scatters hardly any light.
bool isSmooth(const ShotLayers& layers, size_t p) {
    const image::Image* const diffuse = layers.find("albedo");
    return !diffuse || sumAt(*diffuse, p) < 0.05f * sumAt(*layers.find("albedoSpecular"), p);
}

}  // namespace

void addMirroredEmission(const ShotLayers& layers, const Encoding& encoding,
                         const std::vector<float>& distance, HostFrame& frame) {
    const image::Image* const light = layers.find("mirroredEmission");
    const image::Image* const normal = layers.find("normal");
    const image::Image* const seen = layers.find("cameraNormal");
    const image::Image* const length = layers.find("distance");
    const bool known = light && normal && seen && length && layers.find("albedoReflected") &&
                       layers.find("albedoSpecular") && encoding.normalSpace == NormalSpace::World;
    if (!known || frame.specular.empty()) return;
    const mat3 axes = axesOf(frame.camera);
    const auto vectorOf = [](const image::Image& image, size_t p, const vec3& scale) {
        return vec3(image.pixels[3 * p], image.pixels[3 * p + 1], image.pixels[3 * p + 2]) * scale;
    };
    forEachPixel(distance.size(), [&](size_t p) {
        if (!(distance[p] > 0.0f) || !reflects(layers, p, 0.95f)) return;
        // The normal is that of what the mirror shows, or none where it shows the sky. At the mirror's edge
        // the pixel scatters, too.
        const vec3 own = vectorOf(*normal, p, encoding.normalScale);
        const vec3 shown = axes * vectorOf(*seen, p, encoding.cameraNormalScale);
        const bool goesOn = length->pixels[p] > 1.02f * distance[p] && isSmooth(layers, p);
        if (!goesOn && !(glm::distance(own, shown) > 0.25f)) return;
        for (size_t c = 0; c < 3; ++c) {
            const float emitted = light->pixels[3 * p + c];
            frame.emission[4 * p + c] += emitted;
            frame.specular[4 * p + c] -= emitted;
        }
    });
}

void addReflectionMotion(const ShotLayers& layers, const CameraParams& previous, HostFrame& frame) {
    const image::Image* const length = layers.find("distance");
    const image::Image* const reflected = layers.find("albedoReflected");
    const image::Image* const specular = layers.find("albedoSpecular");
    const bool perspective = frame.camera.orthographic == 0 && previous.orthographic == 0;
    if (!length || !reflected || !specular || !perspective) return;
    frame.reflectionMotion.resize(4 * frame.pixelCount());
    const float lacking = nearDistance(*length, frame);
    const Mirrors mirrors(frame);
    forEachPixel(frame.pixelCount(), [&](size_t p) {
        const float distance = frame.depth[4 * p], hit = length->pixels[p] + lacking - distance;
        if (!(distance > 0.0f && hit > 0.02f * distance && reflects(layers, p, 0.5f) && isSmooth(layers, p)))
            return;
        const auto curvature = mirrors.curvatureAt(p);
        if (!curvature) return;
        const float inverse = 1.0f / hit + 2.0f * *curvature;
        if (!(inverse > 0.0f)) return;
        const vec3 point = mirrors.pointAt(p), normal = vectorAt(frame.normal, p);
        const vec2 pixel = pixelOf(p, frame);
        const auto before = seenAt(point + viewOf(pixel, frame.camera, frame) / inverse, previous, frame);
        if (!before) return;
        // Where the previous ray meets the mirror.
        const float facing = glm::dot(viewOf(*before, previous, frame), normal);
        const float reflector = facing != 0.0f ? glm::dot(point - previous.origin, normal) / facing : 0.0f;
        if (!(reflector > 0.0f)) return;
        const float texel[] = {before->x - pixel.x, before->y - pixel.y, reflector - distance, 1.0f};
        std::copy_n(texel, 4, &frame.reflectionMotion[4 * p]);
    });
}

void dropMovingMirrors(const CameraParams& previous, HostFrame& frame) {
    if (frame.reflectionMotion.empty()) return;
    const Mirrors mirrors(frame);
    forEachPixel(frame.pixelCount(), [&](size_t p) {
        float* const moved = &frame.reflectionMotion[4 * p];
        if (!(moved[3] > 0.0f)) return;
        const auto still = seenAt(mirrors.pointAt(p), previous, frame);
        const vec2 own(frame.motion[4 * p], frame.motion[4 * p + 1]);
        const bool known = still && frame.motion[4 * p + 3] > 0.0f;
        if (!known || glm::distance(own, *still - pixelOf(p, frame)) > stillness) std::fill_n(moved, 4, 0.0f);
    });
}

}  // namespace limpid::shot
