#include "embree_tracer.h"

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#ifdef __SSE__
#include <immintrin.h>
#endif

#include "base/error.h"

namespace limpid::bench {
namespace {

constexpr uint32_t tileSize = 16;
constexpr uint32_t maxCulled = 64;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Treats denormals as 0 while it exists, as Embree's manual recommends for tracing threads.
class FlushDenormals {
  public:
#ifdef __SSE__
    FlushDenormals() : before_(_mm_getcsr()) {
        _mm_setcsr(before_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
    }
    ~FlushDenormals() {
        _mm_setcsr(before_);
    }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

  private:
    unsigned before_;
#endif
};

/// The random numbers of shaders/rng.glsl.
class Random {
  public:
    Random(uint32_t pixel, uint32_t frame, uint32_t seed)
        : state_(tea(pixel, frame ^ (seed * 0x9e3779b9u))) {}

    float next() {
        const uint32_t word = ((state_ >> ((state_ >> 28) + 4u)) ^ state_) * 277803737u;
        state_ = state_ * 747796405u + 2891336453u;
        return static_cast<float>(((word >> 22) ^ word) >> 8) * 0x1p-24f;
    }
    vec2 next2() {
        const float x = next();
        return {x, next()};
    }

  private:
    static uint32_t tea(uint32_t v0, uint32_t v1) {
        uint32_t sum = 0;
        for (int round = 0; round < 16; ++round) {
            sum += 0x9e3779b9u;
            v0 += ((v1 << 4) + 0xa341316cu) ^ (v1 + sum) ^ ((v1 >> 5) + 0xc8013ea4u);
            v1 += ((v0 << 4) + 0xad90777du) ^ (v0 + sum) ^ ((v0 >> 5) + 0x7e95761eu);
        }
        return v0;
    }

    uint32_t state_;
};

struct Ray {
    vec3 origin, direction;
};

struct Surface {
    vec3 position, normal;  ///< unit; on the viewer's side
    float magnitude;
    const MaterialRecord* material;
    float lightDensity;
    bool front;
};

bool isFinite(const vec3& v) {
    const auto finite = [](float f) { return (std::bit_cast<uint32_t>(f) & 0x7f800000u) != 0x7f800000u; };
    return finite(v.x) && finite(v.y) && finite(v.z);
}

vec3 offsetRay(const vec3& p, const vec3& normal, float magnitude) {
    return p + normal * (128.0f / 16777216.0f * magnitude);
}

float powerHeuristic(float a, float b) {
    const float a2 = a * a, b2 = b * b;
    return a2 > 0.0f ? a2 / (a2 + b2) : 0.0f;
}

struct HemisphereSample {
    vec3 direction;
    float cosine;
};

/// Samples a cosine-weighted direction about the unit vector n, with the frame and warp of
/// shaders/sampling.glsl.
HemisphereSample sampleHemisphere(const vec3& n, const vec2& u) {
    const float s = n.z >= 0.0f ? 1.0f : -1.0f;
    const float a = -1.0f / (s + n.z);
    const float b = n.x * n.y * a;
    const vec3 tangent(1.0f + s * n.x * n.x * a, s * b, -s * n.x), bitangent(b, s + n.y * n.y * a, -n.y);
    const float r = std::sqrt(u.x), phi = 2.0f * pi * u.y;
    // The compiler combines these into one sincosf().
    const float x = r * std::cos(phi), y = r * std::sin(phi), z = std::sqrt(std::max(0.0f, 1.0f - u.x));
    return {x * tangent + y * bitangent + z * n, z};
}

/// Traces the paths of one tile.
class PathTracer {
  public:
    PathTracer(const EmbreeScene& scene, const EmbreeLaunch& launch) : scene_(scene), launch_(launch) {
        rtcInitIntersectContext(&context_);
    }

    uint64_t rays() const { return rays_; }

    vec3 sample(uint32_t x, uint32_t y) {
        Random random(y * launch_.width + x, launch_.frame, launch_.seed);
        const vec2 jitter = random.next2();
        const vec2 point = vec2(x, y) + (launch_.frame == 0 ? vec2(0.5f) : jitter);
        return trace(cameraRay(point), random);
    }

  private:
    Ray cameraRay(const vec2& pixel) const {
        const CameraParams& camera = launch_.camera;
        const vec2 p = vec2(2.0f, -2.0f) * pixel / vec2(launch_.width, launch_.height) + vec2(-1.0f, 1.0f);
        const vec3 offset = p.x * camera.right + p.y * camera.up;
        if (camera.orthographic != 0) return {camera.origin + offset, camera.forward};
        return {camera.origin, glm::normalize(camera.forward + offset)};
    }

    RTCRayHit intersect(const Ray& ray) {
        RTCRayHit query;
        query.ray = {.org_x = ray.origin.x,
                     .org_y = ray.origin.y,
                     .org_z = ray.origin.z,
                     .tnear = 0.0f,
                     .dir_x = ray.direction.x,
                     .dir_y = ray.direction.y,
                     .dir_z = ray.direction.z,
                     .time = 0.0f,
                     .tfar = infinity,
                     .mask = ~0u,
                     .id = 0,
                     .flags = 0};
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        ++rays_;
        rtcIntersect1(scene_.handle(), &context_, &query);
        return query;
    }

    bool occluded(const vec3& from, const vec3& to) {
        const vec3 path = to - from;
        const float distance = glm::length(path);
        const vec3 direction = path / std::max(distance, 1e-37f);
        RTCRay query{.org_x = from.x,
                     .org_y = from.y,
                     .org_z = from.z,
                     .tnear = 0.0f,
                     .dir_x = direction.x,
                     .dir_y = direction.y,
                     .dir_z = direction.z,
                     .time = 0.0f,
                     .tfar = distance,
                     .mask = ~0u,
                     .id = 0,
                     .flags = 0};
        ++rays_;
        rtcOccluded1(scene_.handle(), &context_, &query);
        return query.tfar < 0.0f;
    }

    Surface surfaceAt(const RTCHit& hit, const vec3& direction) const {
        const TriangleRecord& t = scene_.triangles()[hit.primID];
        const bool front = glm::dot(t.normal, direction) <= 0.0f;
        return {.position = t.v0 + hit.u * t.edge1 + hit.v * t.edge2,
                .normal = front ? t.normal : -t.normal,
                .magnitude = t.magnitude,
                .material = &scene_.materials()[t.material],
                .lightDensity = t.lightDensity,
                .front = front};
    }

    vec3 trace(Ray ray, Random& random) {
        vec3 radiance(0.0f), throughput(1.0f);
        float bsdfPdf = 0.0f;
        uint32_t culled = 0;
        for (uint32_t depth = 0; depth <= launch_.maxDepth; ++depth) {
            const RTCRayHit found = intersect(ray);
            if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
            const Surface surface = surfaceAt(found.hit, ray.direction);
            const bool visible = surface.front || surface.material->doubleSided;
            if (depth == 0 && !visible && ++culled < maxCulled) {
                ray.origin = offsetRay(surface.position, -surface.normal, surface.magnitude);
                --depth;
                continue;
            }
            if (visible && surface.material->emission != vec3(0.0f)) {
                radiance += throughput * surface.material->emission *
                            emissionWeight(surface, ray.direction, found.ray.tfar, depth, bsdfPdf);
            }
            if (depth == launch_.maxDepth) break;
            throughput *= surface.material->albedo;
            radiance += throughput * directLight(surface, throughput, random);
            // The cosine in the density cancels against the cosine factor: only the albedo remains.
            const HemisphereSample next = sampleHemisphere(surface.normal, random.next2());
            bsdfPdf = next.cosine / pi;
            if (depth >= launch_.rouletteDepth && !survives(throughput, random)) break;
            if (throughput == vec3(0.0f)) break;
            ray = {offsetRay(surface.position, surface.normal, surface.magnitude), next.direction};
        }
        return radiance;
    }

    /// The weight of multiple importance sampling for emission that the path hits.
    static float emissionWeight(const Surface& surface, const vec3& direction, float distance, uint32_t depth,
                                float bsdfPdf) {
        if (depth == 0) return 1.0f;
        const float cosine = std::abs(glm::dot(surface.normal, direction));
        const float density = cosine > 0.0f ? surface.lightDensity * distance * distance / cosine : 0.0f;
        return powerHeuristic(bsdfPdf, density);
    }

    /// As takePart() and chooseTriangle() of the shaders (src/shaders/material/lights.glsl).
    static uint32_t takePart(float first, float second, float& u) {
        const float share = first / (first + second);
        const bool isFirst = u < share;
        u = std::clamp(isFirst ? u / share : (u - share) / (1.0f - share), 0.0f, 1.0f - 0x1p-24f);
        return isFirst ? 0 : 1;
    }
    uint32_t chosenLight(float u) const {
        const auto count = static_cast<uint32_t>(scene_.lights().size());
        uint32_t at = 0, first = 0;
        for (uint32_t level = static_cast<uint32_t>(std::bit_width(count * 2 - 1)) / 2; level > 0; --level) {
            const vec4 parts = scene_.lightPyramid()[first + at];
            first += (count + (1u << (2 * level)) - 1) >> (2 * level);
            const uint32_t pair = takePart(parts.x + parts.y, parts.z + parts.w, u);
            const vec2 of = pair == 0 ? vec2(parts.x, parts.y) : vec2(parts.z, parts.w);
            at = 4 * at + 2 * pair + takePart(of.x, of.y, u);
        }
        return at;
    }

    /// Light from one point on one light, times cosine over pi. The albedo is already in the throughput.
    vec3 directLight(const Surface& surface, const vec3& throughput, Random& random) {
        const float choice = random.next();
        const vec2 u = random.next2();
        const std::vector<LightRecord>& lights = scene_.lights();
        if (lights.empty()) return vec3(0.0f);
        const LightRecord& light = lights[chosenLight(choice)];

        const float root = std::sqrt(u.x);
        const vec3 point = light.v0 + root * (1.0f - u.y) * light.edge1 + root * u.y * light.edge2;
        const vec3 toLight = point - surface.position;
        const float distance2 = glm::dot(toLight, toLight);
        const vec3 direction = toLight / std::max(std::sqrt(distance2), 1e-37f);
        float lightCosine = -glm::dot(light.normal, direction);
        vec3 lightNormal = light.normal;
        if (light.twoSided && lightCosine < 0.0f) {
            lightCosine = -lightCosine;
            lightNormal = -lightNormal;
        }
        const float cosine = glm::dot(direction, surface.normal);
        if (!(lightCosine > 0.0f && cosine > 0.0f) || throughput * light.emission == vec3(0.0f))
            return vec3(0.0f);
        const float pdf = light.probability * 2.0f * distance2 / (light.doubleArea * lightCosine);
        const float bsdfPdf = cosine / pi;
        const vec3 from = offsetRay(surface.position, surface.normal, surface.magnitude);
        if (occluded(from, offsetRay(point, lightNormal, light.magnitude))) return vec3(0.0f);
        return light.emission * (powerHeuristic(pdf, bsdfPdf) * bsdfPdf / std::max(pdf, 1e-30f));
    }

    /// Russian roulette; survivors are weighted by the inverse probability.
    static bool survives(vec3& throughput, Random& random) {
        const float survival = std::min(std::max({throughput.x, throughput.y, throughput.z}), 0.95f);
        if (random.next() >= survival) return false;
        throughput /= survival;
        return true;
    }

    const EmbreeScene& scene_;
    const EmbreeLaunch& launch_;
    RTCIntersectContext context_;
    uint64_t rays_ = 0;
};

}  // namespace

uint64_t traceSample(const EmbreeScene& scene, const EmbreeLaunch& launch, std::span<vec4> sum) {
    if (sum.size() != size_t{launch.width} * launch.height)
        throw Error("the sum has another size than the picture");
    std::atomic<uint64_t> rays{0};
    const auto tile = [&](const tbb::blocked_range2d<uint32_t>& range) {
        const FlushDenormals flush;
        PathTracer tracer(scene, launch);
        for (uint32_t y = range.rows().begin(); y < range.rows().end(); ++y) {
            for (uint32_t x = range.cols().begin(); x < range.cols().end(); ++x) {
                const vec3 radiance = tracer.sample(x, y);
                if (isFinite(radiance)) sum[size_t{y} * launch.width + x] += vec4(radiance, 1.0f);
            }
        }
        rays.fetch_add(tracer.rays(), std::memory_order_relaxed);
    };
    tbb::parallel_for(tbb::blocked_range2d<uint32_t>(0, launch.height, tileSize, 0, launch.width, tileSize),
                      tile, tbb::simple_partitioner());
    return rays;
}

}  // namespace limpid::bench
