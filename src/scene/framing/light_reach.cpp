#include "scene/framing/light_reach.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "scene/framing/host_tracer.h"
#include "scene/model/camera.h"

namespace limpid::scene {
namespace {

constexpr uint32_t width = 64, height = 36, pathsPerPixel = 4;
constexpr int bounces = 8;
/// The maximum number of back faces of single-sided surfaces that a camera ray passes through.
constexpr int maxCulled = 16;
constexpr float farAway = 1e30f;
/// A texel below this is black: JPEG compression turns black into values up to 6 of 255.
constexpr float compressedBlack = 0.002f;
/// Darker surfaces, relative to the mean of all, look black on a screen.
constexpr float darkest = 1.0f / 1024.0f;

class Random {
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    float next() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }

  private:
    std::mt19937 engine_;
};

float luminance(const vec3& c) {
    return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}

vec3 cosineDirection(const vec3& normal, Random& random) {
    const float z = 1.0f - 2.0f * random.next(), angle = 2.0f * pi * random.next();
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    const vec3 direction = normal + vec3(r * std::cos(angle), r * std::sin(angle), z);
    return glm::dot(direction, direction) > 1e-8f ? glm::normalize(direction) : normal;
}

/// Emissive triangles, sampled by power, and punctual lights.
class Lights {
  public:
    Lights(const Scene& scene, const HostTracer& tracer) : scene_(scene), tracer_(tracer) {
        for (uint32_t i = 0; i < tracer.triangles().size(); ++i) {
            const HostTriangle& triangle = tracer.triangles()[i];
            const float power =
                luminance(tracer.materialOf(triangle).emission) * 0.5f * glm::length(triangle.areaNormal());
            if (!(power > 0.0f) || !std::isfinite(power)) continue;
            sum_ += double{power};
            cumulative_.push_back(sum_);
            emissive_.push_back(i);
        }
    }

    vec3 emission(const HostTriangle& triangle, float u, float v) const {
        const Material& material = tracer_.materialOf(triangle);
        const vec3 texel(tracer_.textureAt(material.emissionTexture, triangle, u, v));
        const bool black = std::max({texel.r, texel.g, texel.b}) < compressedBlack;
        return black ? vec3(0.0f) : material.emission * texel;
    }

    /// Returns the irradiance from one emissive triangle and one punctual light, chosen at random.
    vec3 irradiance(const vec3& from, const vec3& normal, float offset, Random& random) const {
        vec3 sum(0.0f);
        if (!emissive_.empty()) sum += fromTriangle(from, normal, offset, random);
        if (!scene_.lights.empty()) sum += fromPunctual(from, normal, offset, random);
        return sum;
    }

  private:
    /// Panes let a ray through by chance.
    bool occluded(const vec3& from, const vec3& way, float offset, float farthest, Random& random) const {
        const float step = offset / glm::length(way);
        float nearest = step;
        for (int pane = 0; pane <= bounces; ++pane) {
            const auto hit = tracer_.closest(from, way, nearest, farthest, random.next());
            if (!hit) return false;
            const Material& material = tracer_.materialOf(tracer_.triangles()[hit->triangle]);
            const float through = material.thin ? (1.0f - material.metallic) * material.transmission : 0.0f;
            if (random.next() >= through) return true;
            nearest = hit->t + step;
        }
        return true;
    }

    vec3 fromTriangle(const vec3& from, const vec3& normal, float offset, Random& random) const {
        const double choice = double{random.next()} * sum_;
        const auto at =
            std::upper_bound(cumulative_.begin(), cumulative_.end(), choice) - cumulative_.begin();
        const size_t number = std::min(static_cast<size_t>(at), emissive_.size() - 1);
        const HostTriangle& light = tracer_.triangles()[emissive_[number]];
        const double probability =
            (cumulative_[number] - (number > 0 ? cumulative_[number - 1] : 0.0)) / sum_;
        const float root = std::sqrt(random.next()), second = random.next();
        const float u = root * (1.0f - second), v = root * second;
        const vec3 way = light.v0 + u * light.edge1 + v * light.edge2 - from;
        const vec3 area = 0.5f * light.areaNormal();
        const float distance2 = glm::dot(way, way), cosine = glm::dot(way, normal);
        float lightCosine = -glm::dot(way, area);
        if (tracer_.materialOf(light).doubleSided) lightCosine = std::abs(lightCosine);
        if (!(cosine > 0.0f && lightCosine > 0.0f) || occluded(from, way, offset, 0.999f, random))
            return vec3(0.0f);
        return emission(light, u, v) * static_cast<float>(double{cosine} * double{lightCosine} /
                                                          double{distance2 * distance2} / probability);
    }

    vec3 fromPunctual(const vec3& from, const vec3& normal, float offset, Random& random) const {
        const auto count = static_cast<float>(scene_.lights.size());
        const auto number = std::min(static_cast<size_t>(random.next() * count), scene_.lights.size() - 1);
        const PunctualLight& light = scene_.lights[number];
        const bool sun = light.kind == PunctualLight::Kind::Directional;
        const vec3 way = sun ? -light.direction : light.position - from;
        const float distance = glm::length(way);
        const float cosine = glm::dot(way, normal) / distance;
        if (!(cosine > 0.0f)) return vec3(0.0f);
        vec3 result = light.intensity * (cosine * count);
        if (!sun) result /= distance * distance;
        if (light.range > 0.0f && !sun)
            result *= std::clamp(1.0f - std::pow(distance / light.range, 4.0f), 0.0f, 1.0f);
        if (light.kind == PunctualLight::Kind::Spot &&
            glm::dot(light.direction, -way) < distance * std::cos(light.outerCone))
            return vec3(0.0f);
        if (luminance(result) <= 0.0f) return vec3(0.0f);
        return occluded(from, way, offset, sun ? farAway : 0.999f, random) ? vec3(0.0f) : result;
    }

    const Scene& scene_;
    const HostTracer& tracer_;
    std::vector<uint32_t> emissive_;
    std::vector<double> cumulative_;
    double sum_ = 0.0;
};

struct Ray {
    vec3 origin, direction;
};

/// Returns the radiance of a path; negative if it hits no surface. Materials are diffuse, mirrors or clear.
class Paths {
  public:
    Paths(const Scene& scene, const Camera& camera)
        : camera_(cameraParams(camera, width, height)), tracer_(scene), lights_(scene, tracer_) {}

    float follow(uint32_t pixel, Random& random) const {
        const float x = (static_cast<float>(pixel % width) + random.next()) * 2.0f / width - 1.0f;
        const float y = 1.0f - (static_cast<float>(pixel / width) + random.next()) * 2.0f / height;
        const vec3 offset = x * camera_.right + y * camera_.up;
        Ray ray = camera_.orthographic != 0u ? Ray{camera_.origin + offset, camera_.forward}
                                             : Ray{camera_.origin, camera_.forward + offset};
        ray.direction = glm::normalize(ray.direction);
        vec3 throughput(1.0f), found(0.0f);
        bool direct = true;
        float nearest = 0.0f;
        int culled = 0;
        for (int depth = 0; depth <= bounces; ++depth) {
            const auto hit = tracer_.closest(ray.origin, ray.direction, nearest, farAway, random.next());
            if (!hit) return depth == 0 ? -1.0f : luminance(found);
            const HostTriangle& triangle = tracer_.triangles()[hit->triangle];
            const Material& material = tracer_.materialOf(triangle);
            const bool front = glm::dot(triangle.areaNormal(), ray.direction) < 0.0f;
            const bool visible = front || material.doubleSided;
            ray.origin += hit->t * ray.direction;
            nearest = 1e-5f * (glm::length(ray.origin) + hit->t);
            if (depth == 0 && !visible && material.transmission == 0.0f && ++culled < maxCulled) {
                --depth;
                continue;
            }
            const vec3 color = vec3(material.baseColor) *
                               vec3(tracer_.textureAt(material.baseColorTexture, triangle, hit->u, hit->v));
            if (material.unlit) return luminance(found + throughput * color);
            if (direct && visible) found += throughput * lights_.emission(triangle, hit->u, hit->v);
            vec3 normal = glm::normalize(triangle.areaNormal());
            if (!front) normal = -normal;
            direct = scatter(material, color, normal, ray, throughput, found, nearest, random);
        }
        return luminance(found);
    }

  private:
    /// Returns true if the path continues in the only possible direction, so that no light was sampled here.
    bool scatter(const Material& material, const vec3& color, const vec3& normal, Ray& ray, vec3& throughput,
                 vec3& found, float offset, Random& random) const {
        const float choice = random.next();
        if (choice < (1.0f - material.metallic) * material.transmission) {
            throughput *= color;
            return true;
        }
        const bool mirror = material.roughness < 0.2f && random.next() < std::max(material.metallic, 0.05f);
        if (mirror) {
            throughput *= glm::mix(vec3(1.0f), color, material.metallic);
            ray.direction = glm::reflect(ray.direction, normal);
            return true;
        }
        throughput *= glm::max(color, vec3(0.04f));
        found += throughput / pi * lights_.irradiance(ray.origin, normal, offset, random);
        ray.direction = cosineDirection(normal, random);
        return false;
    }

    CameraParams camera_;
    HostTracer tracer_;
    Lights lights_;
};

}  // namespace

LightReach estimateLightReach(const Scene& scene, const Camera& camera) {
    const Paths paths(scene, camera);
    struct Pixel {
        float light = 0.0f;
        bool seen = false;
    };
    std::vector<Pixel> pixels(size_t{width} * height);
    tbb::parallel_for(uint32_t{0}, width * height, [&](uint32_t pixel) {
        Random random(pixel * 7919u + 1u);
        for (uint32_t i = 0; i < pathsPerPixel; ++i) {
            const float found = paths.follow(pixel, random);
            if (found < 0.0f) continue;
            pixels[pixel].seen = true;
            if (std::isfinite(found)) pixels[pixel].light += found / pathsPerPixel;
        }
    });
    LightReach reach;
    double sum = 0.0;
    for (const Pixel& pixel : pixels) {
        reach.surfaces += pixel.seen;
        sum += double{pixel.light};
    }
    const double threshold = double{darkest} * sum / std::max(reach.surfaces, 1u);
    for (const Pixel& pixel : pixels) reach.dark += pixel.seen && !(double{pixel.light} > threshold);
    return reach;
}

}  // namespace limpid::scene
