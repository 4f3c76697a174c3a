#include "shot/frame/pixel_layers.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace limpid::shot {
namespace {

using denoise::HostFrame;
using image::Image;

vec3 vectorAt(const Image& image, size_t p) {
    return {image.pixels[3 * p], image.pixels[3 * p + 1], image.pixels[3 * p + 2]};
}

/// The normals in world space. A pixel at an edge has a mean of several normals, which is shorter than 1 and
/// fits none of its neighbours: it gets that of the neighbour at the most similar distance.
class Normals {
  public:
    Normals(const ShotLayers& layers, const LayerMap& map, const CameraParams& camera,
            const std::vector<float>& distance)
        : layers_(layers),
          distance_(distance),
          file_(layers.find("normal")),
          ids_(layers.find("id")),
          axes_(axesOf(camera)),
          scale_(map.encoding.normalScale),
          turned_(map.encoding.normalSpace == NormalSpace::Camera) {}

    vec3 at(size_t p) const {
        if (!file_) return axes_[2];
        const size_t from = isMixed(p) ? likestNeighbour(p) : p;
        const vec3 n = vectorAt(*file_, from) * scale_;
        const float length = glm::length(n);
        if (!(length > 0.0f && std::isfinite(length))) return axes_[2];
        return (turned_ ? axes_ * n : n) / length;
    }

  private:
    bool isMixed(size_t p) const {
        const float length = glm::length(vectorAt(*file_, p));
        return !(length > 0.98f);
    }

    size_t likestNeighbour(size_t p) const {
        const auto x = static_cast<int64_t>(p % layers_.width), y = static_cast<int64_t>(p / layers_.width);
        size_t best = p;
        float least = 0.05f * distance_[p];
        for (int64_t v = std::max<int64_t>(y - 1, 0); v <= std::min<int64_t>(y + 1, layers_.height - 1); ++v)
            for (int64_t u = std::max<int64_t>(x - 1, 0); u <= std::min<int64_t>(x + 1, layers_.width - 1);
                 ++u) {
                const auto q = static_cast<size_t>(v * layers_.width + u);
                const float away = std::abs(distance_[q] - distance_[p]);
                const bool same = !ids_ || ids_->pixels[q] == ids_->pixels[p];
                if (!same || away >= least || isMixed(q)) continue;
                least = away;
                best = q;
            }
        return best;
    }

    const ShotLayers& layers_;
    const std::vector<float>& distance_;
    const Image* file_;
    const Image* ids_;
    mat3 axes_;
    vec3 scale_;
    bool turned_;
};

/// Of light that is shown as it is.
float limited(float value) {
    if (std::isfinite(value)) return value;
    return value > 0.0f ? largestHalf : 0.0f;
}

void copyColor(const Image* from, std::vector<float>& to) {
    if (!from) return std::fill(to.begin(), to.end(), 1.0f);
    forEachPixel(to.size() / 4, [&](size_t p) { std::copy_n(&from->pixels[3 * p], 3, &to[4 * p]); });
}

/// What the layers of light leave of the beauty, and the beauty's energy: means over every fifth pixel.
struct Balance {
    double beauty = 0.0, rest = 0.0, restWithBackground = 0.0;
};
Balance balanceOf(const ShotLayers& layers, const std::vector<float>& distance) {
    const Image* const parts[] = {layers.find("diffuse"), layers.find("specular"), layers.find("emission")};
    const Image* const background = layers.find("background");
    Balance balance;
    for (size_t p = 0; p < distance.size(); p += 5) {
        if (!(distance[p] > 0.0f)) continue;
        const vec3 beauty = vectorAt(layers.images.at("beauty"), p);
        vec3 rest = beauty;
        for (const Image* part : parts)
            if (part) rest -= vectorAt(*part, p);
        const float energy = std::abs(luminance(beauty)), left = std::abs(luminance(rest));
        if (!std::isfinite(energy) || !std::isfinite(left)) continue;
        balance.beauty += static_cast<double>(energy);
        balance.rest += static_cast<double>(std::min(left, energy));
        if (!background) continue;
        const float with = std::abs(luminance(rest - vectorAt(*background, p)));
        balance.restWithBackground += static_cast<double>(std::min(with, energy));
    }
    return balance;
}

}  // namespace

vec2 onScreen(size_t p, const ShotLayers& layers) {
    const auto x = static_cast<float>(p % layers.width), y = static_cast<float>(p / layers.width);
    return {2.0f * (x + 0.5f) / static_cast<float>(layers.width) - 1.0f,
            1.0f - 2.0f * (y + 0.5f) / static_cast<float>(layers.height)};
}

vec3 rayOf(const CameraParams& camera, const vec2& at) {
    return camera.orthographic != 0 ? camera.forward
                                    : camera.forward + at.x * camera.right + at.y * camera.up;
}

vec3 startOf(const CameraParams& camera, const vec2& at) {
    return camera.orthographic != 0 ? camera.origin + at.x * camera.right + at.y * camera.up : camera.origin;
}

mat3 axesOf(const CameraParams& camera) {
    const vec3 right = glm::normalize(camera.right), up = glm::normalize(camera.up);
    return {right, up, glm::cross(right, up)};
}

Image scaledNormals(const Image& normals, const vec3& scale) {
    Image result = normals;
    forEachPixel(result.pixels.size() / 3, [&](size_t p) {
        const vec3 n = vectorAt(normals, p) * scale;
        const float length = glm::length(n);
        const vec3 unit = length > 0.0f && std::isfinite(length) ? n / length : vec3(0.0f);
        for (int c = 0; c < 3; ++c) result.pixels[3 * p + static_cast<size_t>(c)] = unit[c];
    });
    return result;
}

std::optional<vec2> motionAt(const Image& motion, size_t p, const Encoding& encoding) {
    vec2 moved(motion.pixels[motion.components * p], motion.pixels[motion.components * p + 1]);
    if (!(std::abs(moved.x) < encoding.noMotion && std::abs(moved.y) < encoding.noMotion))
        return std::nullopt;
    moved *= encoding.motionScale;
    if (encoding.motionUnit == MotionUnit::Picture) moved *= vec2(motion.width, motion.height);
    return moved;
}

std::vector<float> distancesOf(const ShotLayers& layers, const Encoding& encoding,
                               const CameraParams& camera) {
    std::vector<float> result(size_t{layers.width} * layers.height);
    const Image* const depth = layers.find("depth");
    const Image* const normal = layers.find("normal");
    const Image* const mean = layers.find("distance");
    const Image* const alpha = layers.find("alpha");
    const bool planar = (!depth || encoding.depthKind == DepthKind::Planar) && camera.orthographic == 0;
    const auto isHit = [&](float z) { return z > 0.0f && z < encoding.farDepth; };
    forEachPixel(result.size(), [&](size_t p) {
        if (layers.isTransparent && !(alpha->pixels[p] > 0.0f)) return;
        const float z = depth ? depth->pixels[p] : 1.0f;
        if (depth && !isHit(z)) {
            // The sample of the depth missed, but others did not.
            if (mean && layers.isTransparent && isHit(mean->pixels[p]))
                result[p] = mean->pixels[p] / alpha->pixels[p];
            return;
        }
        if (!depth && normal && vectorAt(*normal, p) == vec3(0.0f)) return;
        result[p] = planar ? z * glm::length(rayOf(camera, onScreen(p, layers))) : z;
    });
    return result;
}

double addLight(const ShotLayers& layers, const std::vector<float>& distance, HostFrame& frame) {
    const Image& beauty = layers.images.at("beauty");
    const Image* const diffuse = layers.find("diffuse");
    const Image* const emission = layers.find("emission");
    const bool two = diffuse && layers.find("specular");
    const Balance balance = balanceOf(layers, distance);
    const Image* background = layers.find("background");
    const double rest = background ? std::min(balance.rest, balance.restWithBackground) : balance.rest;
    if (balance.restWithBackground >= balance.rest) background = nullptr;
    forEachPixel(distance.size(), [&](size_t p) {
        const vec3 total = vectorAt(beauty, p);
        vec3 own = emission ? vectorAt(*emission, p) : vec3(0.0f);
        if (background) own += vectorAt(*background, p);
        if (!(distance[p] > 0.0f)) own = total;  // what is behind everything is not filtered
        const vec3 first = two && distance[p] > 0.0f ? vectorAt(*diffuse, p) : total - own;
        for (int c = 0; c < 3; ++c) {
            const size_t at = 4 * p + static_cast<size_t>(c);
            frame.emission[at] = own[c];
            frame.diffuse[at] = distance[p] > 0.0f ? first[c] : 0.0f;
            // With what no layer has: volumes, for example. The sum stays the beauty.
            if (two) frame.specular[at] = distance[p] > 0.0f ? total[c] - own[c] - first[c] : 0.0f;
        }
    });
    return two && balance.beauty > 0.0 ? 1.0 - rest / balance.beauty : 1.0;
}

void limitEmission(HostFrame& frame) {
    forEachPixel(frame.pixelCount(), [&](size_t p) {
        for (size_t at = 4 * p; at < 4 * p + 3; ++at) {
            const bool infinite = frame.emission[at] == INFINITY;
            frame.emission[at] = limited(frame.emission[at]);
            if (!infinite) continue;
            for (auto* texels : {&frame.diffuse, &frame.specular})
                if (!texels->empty() && !std::isfinite((*texels)[at])) (*texels)[at] = 0.0f;
        }
    });
}

void limitUnfiltered(const HostFrame& frame, ShotLayers& layers) {
    const auto limit = [&](Image& colors) {
        forEachPixel(frame.pixelCount(), [&](size_t p) {
            if (frame.depth[4 * p + 1] > 0.0f) return;
            for (size_t i = 3 * p; i < 3 * p + 3; ++i) colors.pixels[i] = limited(colors.pixels[i]);
        });
    };
    limit(layers.images.at("beauty"));
    for (Image& group : layers.groups) limit(group);
}

uint64_t countNotFinite(const Image& colors) {
    std::atomic<uint64_t> count = 0;
    forEachPixel(colors.pixels.size() / 3, [&](size_t p) {
        const float* const color = &colors.pixels[3 * p];
        if (!std::all_of(color, color + 3, [](float value) { return std::isfinite(value); })) ++count;
    });
    return count;
}

void addAlbedo(const ShotLayers& layers, HostFrame& frame) {
    copyColor(layers.find("albedo"), frame.albedo);
    if (!frame.albedoSpecular.empty()) copyColor(layers.find("albedoSpecular"), frame.albedoSpecular);
}

void divideByAlpha(const ShotLayers& layers, const std::vector<float>& distance, HostFrame& frame) {
    if (!layers.isTransparent) return;
    const Image& alpha = layers.images.at("alpha");
    for (auto* texels :
         {&frame.diffuse, &frame.specular, &frame.emission, &frame.albedo, &frame.albedoSpecular})
        forEachPixel(texels->size() / 4, [&](size_t p) {
            if (!(distance[p] > 0.0f)) return;
            for (size_t c = 4 * p; c < 4 * p + 3; ++c) (*texels)[c] /= alpha.pixels[p];
        });
}

void addGeometry(const ShotLayers& layers, const LayerMap& map, const std::vector<float>& distance,
                 HostFrame& frame) {
    const Normals normals(layers, map, frame.camera, distance);
    const Image* const ids = layers.find("id");
    forEachPixel(distance.size(), [&](size_t p) {
        if (!(distance[p] > 0.0f)) return;
        const vec3 n = normals.at(p);
        for (int c = 0; c < 3; ++c) frame.normal[4 * p + static_cast<size_t>(c)] = n[c];
        frame.depth[4 * p] = distance[p];
        frame.depth[4 * p + 1] = 1.0f;
        const float id = ids ? ids->pixels[p] : 0.0f;
        frame.ids[2 * p] = id >= 0.0f && id < 4e9f ? static_cast<uint32_t>(id) : 0u;
    });
}

void addSeen(const ShotLayers& layers, const LayerMap& map, HostFrame& frame) {
    const Image* const albedo = layers.find("seenAlbedo");
    const Image* const normal = layers.find("cameraNormal");
    const Image* const length = layers.find("distance");
    if (!albedo || !normal || !length || frame.albedoSpecular.empty()) return;
    const mat3 axes = axesOf(frame.camera);
    const auto colorAt = [](const std::vector<float>& texels, size_t p) {
        return vec3(texels[4 * p], texels[4 * p + 1], texels[4 * p + 2]);
    };
    forEachPixel(frame.pixelCount(), [&](size_t p) {
        // What is seen lies behind the surface, and the surface has hardly any diffuse light.
        const bool behind = frame.depth[4 * p] > 0.0f && length->pixels[p] > 1.02f * frame.depth[4 * p];
        const float diffuse = luminance(colorAt(frame.albedo, p));
        if (!behind || diffuse > 0.05f * luminance(colorAt(frame.albedoSpecular, p))) return;
        const vec3 n = vectorAt(*normal, p) * map.encoding.cameraNormalScale;
        std::copy_n(&albedo->pixels[3 * p], 3, &frame.albedoSpecular[4 * p]);
        const float size = glm::length(n);
        if (!(size > 0.0f && std::isfinite(size))) return;
        const vec3 seen = glm::normalize(axes * n);
        for (int c = 0; c < 3; ++c) frame.normal[4 * p + static_cast<size_t>(c)] = seen[c];
    });
}

}  // namespace limpid::shot
