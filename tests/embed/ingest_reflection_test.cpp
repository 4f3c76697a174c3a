// The motion of reflections that the ingest pass computes from hit distances, against reflections in double
// precision.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "denoise/api/instance.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/embed/synthetic_camera.h"

namespace limpid::test {
namespace {

constexpr uint32_t width = 64, height = 48;
constexpr gpu::Extent extent{width, height};

CameraParams cameraAt(const glm::vec3& eye, const glm::vec3& target) {
    CameraParams camera{};
    camera.origin = eye;
    camera.forward = glm::normalize(target - eye);
    camera.right = glm::normalize(glm::cross(camera.forward, glm::vec3(0, 1, 0)));
    camera.up = glm::cross(camera.right, camera.forward) * (0.4f * height / width);
    camera.right *= 0.4f;
    camera.spread = 0.8f / width;
    return camera;
}

dvec3 rayThrough(const CameraParams& camera, const dvec2& pixel) {
    const double x = 2.0 * (pixel.x + 0.5) / width - 1.0, y = 1.0 - 2.0 * (pixel.y + 0.5) / height;
    return glm::normalize(dvec3(camera.forward) + x * dvec3(camera.right) + y * dvec3(camera.up));
}

/// The pixel (minus one half) at which the camera sees a point.
dvec2 pixelOf(const CameraParams& camera, const dvec3& point) {
    const dvec3 to = point - dvec3(camera.origin);
    const double along = glm::dot(to, dvec3(camera.forward));
    const auto coordinate = [&](const vec3& axis) {
        return glm::dot(to, dvec3(axis)) / glm::dot(dvec3(axis), dvec3(axis)) / along;
    };
    return {(coordinate(camera.right) + 1.0) / 2.0 * width - 0.5,
            (1.0 - coordinate(camera.up)) / 2.0 * height - 0.5};
}

/// A reflector at the origin, around which a shell of radius 10 is reflected: a sphere, or (radius 0) the
/// plane z = 0.
struct Reflector {
    double radius = 0.0;

    /// The distance along a ray; not above 0 if it misses.
    double hit(const dvec3& origin, const dvec3& direction) const {
        if (radius == 0.0) return -origin.z / direction.z;
        const double b = glm::dot(origin, direction);
        const double discriminant = b * b - glm::dot(origin, origin) + radius * radius;
        return discriminant > 0.0 ? -b - std::sqrt(discriminant) : -1.0;
    }

    dvec3 normal(const dvec3& point) const { return radius == 0.0 ? dvec3(0, 0, 1) : glm::normalize(point); }

    /// The point of the reflector at which an eye sees `object`: the shortest way over it (Fermat), by
    /// descent from `start`.
    dvec3 mirrorPoint(const dvec3& eye, const dvec3& object, dvec3 start) const {
        const auto onReflector = [&](const dvec3& p) {
            return radius == 0.0 ? dvec3(p.x, p.y, 0) : radius * glm::normalize(p);
        };
        for (int i = 0; i < 4000; ++i) {
            const dvec3 gradient = glm::normalize(start - eye) + glm::normalize(start - object);
            const dvec3 n = normal(start);
            start = onReflector(start - 0.02 * (gradient - n * glm::dot(gradient, n)));
        }
        return start;
    }
};

double shellDistance(const dvec3& from, const dvec3& direction) {
    const double b = glm::dot(from, direction);
    return -b + std::sqrt(b * b - glm::dot(from, from) + 100.0);
}

/// A frame of a reflector, and the true motion of what it reflects.
struct Frame {
    std::vector<float> normal, depth, roughness, hitDistance;
    std::vector<dvec2> truth;
    std::vector<bool> seen;
};

Frame frameOf(const Reflector& reflector, const CameraParams& now, const CameraParams& before,
              float roughness) {
    Frame frame;
    const size_t count = size_t{width} * height;
    for (auto* image : {&frame.normal, &frame.depth, &frame.roughness, &frame.hitDistance})
        image->assign(4 * count, 0.0f);
    frame.truth.resize(count);
    frame.seen.assign(count, false);
    for (size_t p = 0; p < count; ++p) {
        const dvec2 pixel(static_cast<double>(p % width), static_cast<double>(p / width));
        const dvec3 ray = rayThrough(now, pixel);
        const double distance = reflector.hit(dvec3(now.origin), ray);
        if (distance <= 0.0) continue;
        const dvec3 point = dvec3(now.origin) + distance * ray, n = reflector.normal(point);
        const dvec3 reflected = glm::reflect(ray, n);
        const double hit = shellDistance(point, reflected);
        for (int c = 0; c < 3; ++c) frame.normal[4 * p + static_cast<size_t>(c)] = static_cast<float>(n[c]);
        frame.depth[4 * p] = static_cast<float>(distance);
        frame.roughness[4 * p] = roughness;
        frame.hitDistance[4 * p] = static_cast<float>(hit);
        const dvec3 mirror = reflector.mirrorPoint(dvec3(before.origin), point + hit * reflected, point);
        frame.truth[p] = pixelOf(before, mirror) - pixel;
        frame.seen[p] = true;
    }
    return frame;
}

class IngestReflectionTest : public DenoiseTest {
  protected:
    struct Motions {
        std::vector<float> surface, reflection;  ///< four floats per pixel
    };

    Motions run(const Frame& frame, const CameraParams& now, const CameraParams& before) {
        graph_.beginFrame();
        const auto image = [&](const char* name, const std::vector<float>& pixels) {
            return uploaded(name, pixels, extent);
        };
        denoise::IngestImages images;
        images.radiance = images.normal = image("normal", frame.normal);
        images.depth = image("depth", frame.depth);
        images.roughness = image("roughness", frame.roughness);
        images.hitDistance = image("hit distance", frame.hitDistance);
        limpid_denoiser_desc desc = {};
        desc.width = width;
        desc.height = height;
        const denoise::DenoiserInput input =
            denoise::ingest(graph_, images, denoise::ingestParams(desc, matricesOf(now, before), true),
                            {.twoSignals = true, .layers = true});
        graph_.execute(device());
        return {graph_.downloadFloat(device(), input.motion),
                graph_.downloadFloat(device(), input.reflectionMotion)};
    }

    /// Root mean squared errors in pixels of the surface's motion and of the reflection's, over pixels that
    /// have the latter.
    struct Errors {
        double surface = 0.0, reflection = 0.0;
        size_t count = 0;
    };

    static Errors errorsOf(const Frame& frame, const Motions& motions) {
        Errors errors;
        for (size_t p = 0; p < frame.truth.size(); ++p) {
            if (!frame.seen[p] || motions.reflection[4 * p + 3] == 0.0f) continue;
            const auto squared = [&](const std::vector<float>& motion) {
                const dvec2 off = dvec2(motion[4 * p], motion[4 * p + 1]) - frame.truth[p];
                return glm::dot(off, off);
            };
            errors.surface += squared(motions.surface);
            errors.reflection += squared(motions.reflection);
            ++errors.count;
        }
        for (double* sum : {&errors.surface, &errors.reflection})
            *sum = std::sqrt(*sum / static_cast<double>(std::max<size_t>(errors.count, 1)));
        return errors;
    }

    const CameraParams now_ = cameraAt({0.0f, 1.0f, 4.0f}, {0.0f, 0.0f, 0.0f});
    const CameraParams before_ = cameraAt({0.15f, 1.05f, 4.0f}, {0.0f, 0.0f, 0.0f});
};

TEST_F(IngestReflectionTest, OfAFlatMirrorIsExact) {
    const Frame frame = frameOf({}, now_, before_, 0.0f);
    const Errors errors = errorsOf(frame, run(frame, now_, before_));
    EXPECT_GT(errors.count, size_t{(width - 8) * (height - 8)});
    EXPECT_LT(errors.reflection, 0.02) << "pixels";
    EXPECT_GT(errors.surface, 1.0) << "else the test shows nothing";
}

TEST_F(IngestReflectionTest, FollowsReflectionsInSpheres) {
    for (const double radius : {0.5, 1.0}) {
        const Frame frame = frameOf({radius}, now_, before_, 0.0f);
        const Errors errors = errorsOf(frame, run(frame, now_, before_));
        RecordProperty("radius_" + std::to_string(radius),
                       std::to_string(errors.surface) + " " + std::to_string(errors.reflection));
        EXPECT_GT(errors.count, 150u) << radius;
        EXPECT_LT(errors.reflection, 0.35 * errors.surface) << radius;
    }
}

TEST_F(IngestReflectionTest, RoughSurfacesAndUnknownHitsHaveNone) {
    for (const float roughness : {0.5f, -1.0f, NAN}) {  // negative and NaN: unknown
        const Frame rough = frameOf({}, now_, before_, roughness);
        EXPECT_EQ(errorsOf(rough, run(rough, now_, before_)).count, 0u) << roughness;
    }
    Frame unknown = frameOf({}, now_, before_, 0.0f);
    for (size_t p = 0; p < unknown.truth.size(); ++p)
        unknown.hitDistance[4 * p] = std::array{0.0f, -1.0f, NAN}[p % 3];
    EXPECT_EQ(errorsOf(unknown, run(unknown, now_, before_)).count, 0u);
}

TEST_F(IngestReflectionTest, TheSkyInAFlatMirrorIsFarAway) {
    Frame frame = frameOf({}, now_, before_, 0.0f);
    for (float& distance : frame.hitDistance) distance = 1e12f;
    const Motions motions = run(frame, now_, before_);
    size_t count = 0;
    for (size_t p = 0; p < frame.truth.size(); ++p) {
        if (motions.reflection[4 * p + 3] == 0.0f) continue;
        ++count;
        const dvec2 pixel(static_cast<double>(p % width), static_cast<double>(p / width));
        const dvec3 far = dvec3(before_.origin) + rayThrough(now_, pixel);
        const dvec2 off =
            dvec2(motions.reflection[4 * p], motions.reflection[4 * p + 1]) - (pixelOf(before_, far) - pixel);
        ASSERT_LT(glm::length(off), 0.02) << "pixel " << p;
    }
    EXPECT_GT(count, frame.truth.size() / 3);
}

}  // namespace
}  // namespace limpid::test
