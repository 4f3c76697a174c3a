#include "tests/oracle/synthetic/synthetic_frames.h"

#include <cmath>
#include <limits>

#include "tests/oracle/synthetic/synthetic_geometry.h"

namespace limpid::test {
namespace {

/// The depth of reflected objects behind their surfaces.
constexpr double reflectionDepth = 2.0;

/// The noise-free components of a surface's light.
struct Shading {
    dvec3 albedo{0.0}, diffuse{0.0}, specular{0.0}, emission{0.0}, albedoSpecular{0.0};
};

/// A checkerboard of 1 and 0 with squares of `side`.
double checker(double u, double v, double side) {
    return std::fmod(std::abs(std::floor(u / side) + std::floor(v / side)), 2.0);
}

dvec3 albedoOf(uint32_t instance, const dvec3& p) {
    switch (instance) {
        case SyntheticScene::Floor:
            return glm::mix(dvec3(0.12, 0.15, 0.2), dvec3(0.8, 0.78, 0.7), checker(p.x, p.z, 0.25));
        case SyntheticScene::Wall:
            return {0.6, 0.3, 0.25};
        case SyntheticScene::Sphere:
            return dvec3(0.05);  // darker than the lower limit in modulation()
        case SyntheticScene::Box:
            return glm::mix(dvec3(0.2, 0.5, 0.3), dvec3(0.7, 0.6, 0.2), checker(p.x + p.z, p.y, 0.2));
        default:
            return dvec3(0.0);
    }
}

/// Irradiance at a point at rest, so that light moves along with moving objects.
dvec3 irradiance(const dvec3& p, const dvec3& n) {
    // The edge of a shadow runs diagonally over the floor, half a unit wide.
    const double lit = glm::smoothstep(-0.25, 0.25, -p.x - 0.4 * p.z - 0.2 + 0.3 * std::sin(p.z));
    const dvec3 sun = dvec3(2.0, 1.8, 1.5) * (0.6 + 0.3 * n.y + 0.1 * n.x);
    return lit * sun + dvec3(0.2, 0.25, 0.35) * (1.0 + 0.3 * std::sin(0.7 * p.x) * std::cos(0.5 * p.z));
}

Shading shade(const SyntheticHit& hit, const dvec3& direction) {
    if (!hit.any()) return {.emission = dvec3(0.4, 0.6, 1.0) * (1.0 + 0.5 * direction.y)};
    if (hit.instance == SyntheticScene::Emitter) return {.emission = dvec3(12.0, 10.0, 8.0)};
    const dvec3 albedo = albedoOf(hit.instance, hit.point);
    const double gloss = hit.instance == SyntheticScene::Sphere ? 0.5 : 0.05;
    const double pattern = 1.0 + 0.5 * std::sin(1.3 * hit.point.x + 0.4) * std::cos(0.9 * hit.point.z);
    const dvec3 albedoSpecular(hit.instance == SyntheticScene::Sphere ? gloss * pattern : 0.04);
    return {albedo, albedo * irradiance(hit.point, hit.normal), dvec3(gloss * pattern), dvec3(0.0),
            albedoSpecular};
}

/// The output function of SplitMix64: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number
/// generators", OOPSLA 2014.
uint64_t mix64(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/// Uniform numbers in (0, 1) that depend only on seed, frame and counter.
class CounterNoise {
  public:
    CounterNoise(uint32_t seed, int frame)
        : key_(mix64((uint64_t{seed} << 32 | static_cast<uint32_t>(frame)) + 1)) {}

    /// Returns a factor of mean 1 and variance 2 e - 1: half of the paths find the light, with a log-normal
    /// value, like a product of many factors.
    double factor(uint64_t pixel, uint64_t lobe) const {
        const uint64_t counter = (pixel * 2 + lobe) * 3;
        if (uniform(counter) < 0.5) return 0.0;
        // Box-Muller transform.
        const double angle = 6.283185307179586 * uniform(counter + 1);
        const double normal = std::sqrt(-2.0 * std::log(uniform(counter + 2))) * std::cos(angle);
        return 2.0 * std::exp(normal - 0.5);
    }

    /// Returns a uniform number that is independent of the factors.
    double choice(uint64_t pixel) const { return uniform((uint64_t{1} << 40) + pixel); }

  private:
    double uniform(uint64_t counter) const {
        const uint64_t bits = mix64(key_ + (counter + 1) * 0x9e3779b97f4a7c15u);
        return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
    }

    uint64_t key_;
};

void append(std::vector<float>& layer, const dvec3& xyz, double w = 0.0) {
    for (int i = 0; i < 3; ++i) layer.push_back(static_cast<float>(xyz[i]));
    layer.push_back(static_cast<float>(w));
}

/// The scene at two times: that of the frame and that of the previous one.
class Moments {
  public:
    Moments(const SyntheticOptions& options, int number, uint32_t width, uint32_t height)
        : camera(cameraOf(options, number, width, height)),
          view(camera, options.scale, width, height),
          previousCamera(cameraOf(options, number - 1, width, height)),
          previousView(previousCamera, options.scale, width, height),
          options_(options),
          number_(number),
          width_(width) {}

    SyntheticHit intersect(const SyntheticRay& ray) const {
        return intersectSynthetic(ray, number_, options_.objectMoves);
    }

    dvec3 normal(const SyntheticHit& hit) const { return pose(hit, 0).rotation() * hit.normal; }
    dvec3 previousNormal(const SyntheticHit& hit) const { return pose(hit, 1).rotation() * hit.normal; }

    void appendMotion(std::vector<float>& layer, const SyntheticHit& hit, const SyntheticRay& ray) const {
        // Both cameras project the point, so that static points have a motion of exactly 0.
        const auto is =
            hit.any() ? view.project(pose(hit, 0).toWorld(hit.point)) : view.projectDirection(ray.direction);
        const auto was = hit.any() ? previousView.project(pose(hit, 1).toWorld(hit.point))
                                   : previousView.projectDirection(ray.direction);
        if (number_ == 0 || !is || !was) return append(layer, dvec3(0.0));
        append(layer, dvec3(was->pixel - is->pixel, options_.scale * (was->distance - is->distance)), 1.0);
    }

    static bool reflects(const SyntheticHit& hit) {
        return hit.any() && hit.instance != SyntheticScene::Wall && hit.instance != SyntheticScene::Emitter;
    }

    /// Appends the motion of a static point reflected behind the hit's plane: its pixel moves like the point,
    /// its distance is that of the plane in its pixel. `choice` in (0, 1) selects deliberate errors.
    void appendReflectionMotion(std::vector<float>& layer, const SyntheticHit& hit, const SyntheticRay& ray,
                                double choice) const {
        if (number_ == 0 || !reflects(hit) || choice < 0.4) return append(layer, dvec3(0.0));
        const dvec3 shown = ray.origin + (hit.distance + reflectionDepth) * ray.direction;
        const auto is = view.project(shown), was = previousView.project(shown);
        if (!is || !was) return append(layer, dvec3(0.0));
        const double moved = was->distance - depthBehindPlane(shown, hit) - hit.distance;
        appendFlawed(layer, dvec3(was->pixel - is->pixel, options_.scale * moved), choice);
    }

    const CameraParams camera;
    const SyntheticView view;
    const CameraParams previousCamera;
    const SyntheticView previousView;

  private:
    static CameraParams cameraOf(const SyntheticOptions& o, int number, uint32_t width, uint32_t height) {
        return syntheticCamera(number, o.cameraMoves, o.orthographic, o.scale, width, height);
    }
    /// Returns how far behind the hit's previous plane the previous camera saw a point.
    double depthBehindPlane(const dvec3& point, const SyntheticHit& hit) const {
        const dvec3 eye = dvec3(previousCamera.origin) / options_.scale;
        const dvec3 along =
            glm::normalize(options_.orthographic ? dvec3(previousCamera.forward) : point - eye);
        const dvec3 n = previousNormal(hit);
        return glm::dot(n, point - pose(hit, 1).toWorld(hit.point)) / glm::dot(n, along);
    }
    /// Appends a reflection motion, with errors for a few choices. Some correct ones have a weight of one
    /// half. Wrong ones are not finite, or so large that even the mean of nine pixels is rejected: it lies
    /// outside the picture (x), or too far away (z).
    void appendFlawed(std::vector<float>& layer, dvec3 r, double choice) const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        if (choice < 0.5) return append(layer, 0.5 * r, 0.5);
        if (choice < 0.51)
            r.x = std::numeric_limits<double>::quiet_NaN();
        else if (choice < 0.52)
            r.z = -infinity;
        else if (choice < 0.525)
            r.x += 16.0 * width_;
        else if (choice < 0.53)
            r.z += 9.0 * options_.scale;
        append(layer, r, 1.0);
    }
    SyntheticPose pose(const SyntheticHit& hit, int framesAgo) const {
        return syntheticPose(hit.instance, number_ - framesAgo, options_.objectMoves);
    }

    const SyntheticOptions& options_;
    int number_;
    uint32_t width_;
};

}  // namespace

denoise::HostFrame SyntheticScene::frame(int number, uint32_t width, uint32_t height, uint32_t seed) const {
    const Moments moments(options_, number, width, height);
    const CounterNoise noise(seed, number);
    denoise::HostFrame frame;
    frame.width = width;
    frame.height = height;
    frame.camera = moments.camera;
    for (uint32_t p = 0; p < width * height; ++p) {
        const SyntheticRay ray = moments.view.centreRay(p % width, p / width);
        const SyntheticHit hit = moments.intersect(ray);
        const Shading shading = shade(hit, ray.direction);
        append(frame.diffuse, shading.diffuse * (options_.noise ? noise.factor(p, 0) : 1.0));
        append(frame.specular, shading.specular * (options_.noise ? noise.factor(p, 1) : 1.0));
        append(frame.emission, shading.emission);
        append(frame.albedo, shading.albedo);
        append(frame.albedoSpecular, shading.albedoSpecular);
        append(frame.normal, moments.normal(hit));
        append(frame.previousNormal, moments.previousNormal(hit));
        append(frame.depth, hit.any() ? dvec3(options_.scale * hit.distance, 1.0, 0.0) : dvec3(0.0));
        moments.appendMotion(frame.motion, hit, ray);
        moments.appendReflectionMotion(frame.reflectionMotion, hit, ray, noise.choice(p));
        const bool reflects = moments.reflects(hit);
        const double gloss = (p / 6 + p / width / 6) % 2 == 0 ? 0.6 : 0.35;
        append(frame.roughness, dvec3(hit.any() && !reflects ? gloss : 0.0, 0.0, 0.0));
        append(frame.hitDistance, reflects ? dvec3(options_.scale * reflectionDepth, 1.0, 0.0) : dvec3(0.0));
        frame.ids.insert(frame.ids.end(), {hit.instance, hit.instance});
    }
    return frame;
}

std::vector<float> SyntheticScene::truth(int number, uint32_t width, uint32_t height) const {
    const Moments moments(options_, number, width, height);
    std::vector<float> beauty;
    for (uint32_t p = 0; p < width * height; ++p) {
        const SyntheticRay ray = moments.view.centreRay(p % width, p / width);
        const Shading shading = shade(moments.intersect(ray), ray.direction);
        append(beauty, shading.diffuse + shading.specular + shading.emission, 1.0);
    }
    return beauty;
}

}  // namespace limpid::test
