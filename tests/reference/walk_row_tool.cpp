// Decides which of two renderers is right about a row of spheres of scripts/cycles (glass-rough,
// metal-white): traces it with the random walk on microfacets (microfacet_walk.h) in double precision and
// prints, per sphere, the mean of the picture's square and how much the renderers' pictures differ:
//
//   limpid_walk_row out/cycles/glass-rough/sky.exr glass out/cycles/glass-rough/mean.{limpid,cycles}.exr
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "image/io/picture.h"
#include "tests/reference/microfacet_walk.h"

namespace {

using namespace limpid;
using glm::dvec3;

constexpr int spheres = 5, side = 2000;
constexpr double radius = 0.48, index = 1.5;
constexpr int maxBounces = 96;

/// The environment as Limpid and Cycles look it up: 2:1, its centre towards -Z, linear between texels.
class Sky {
  public:
    explicit Sky(const char* path) : image_(image::readPicture(path).linear) {}

    dvec3 operator()(const dvec3& d) const {
        const double u = 0.5 + std::atan2(d.x, -d.z) / (2.0 * std::numbers::pi);
        const double v = std::acos(glm::clamp(d.y, -1.0, 1.0)) / std::numbers::pi;
        const double x = u * image_.width - 0.5, y = v * image_.height - 0.5;
        const double left = std::floor(x), top = std::floor(y);
        const int column = static_cast<int>(left), row = static_cast<int>(top);
        return glm::mix(glm::mix(texel(column, row), texel(column + 1, row), x - left),
                        glm::mix(texel(column, row + 1), texel(column + 1, row + 1), x - left), y - top);
    }

  private:
    dvec3 texel(int column, int row) const {
        const int width = static_cast<int>(image_.width), height = static_cast<int>(image_.height);
        const int at = glm::clamp(row, 0, height - 1) * width + (column + width) % width;
        const float* p = &image_.pixels[size_t{3} * static_cast<size_t>(at)];
        return {p[0], p[1], p[2]};
    }

    image::Image image_;
};

struct Material {
    bool glass;
    std::array<double, spheres> roughness;
};

/// Returns the distance at which the ray o + t d hits the sphere around c; negative: a miss.
double distanceTo(const dvec3& c, const dvec3& o, const dvec3& d, bool inside) {
    const dvec3 q = o - c;
    const double b = glm::dot(q, d), discriminant = b * b - glm::dot(q, q) + radius * radius;
    if (discriminant <= 0.0) return -1.0;
    return inside ? -b + std::sqrt(discriminant) : -b - std::sqrt(discriminant);
}

/// Returns the direction after scattering at the sphere's facets; `inside` changes if the ray crosses the
/// boundary.
dvec3 scatter(const dvec3& normal, const dvec3& d, double roughness, bool glass, bool& inside,
              std::mt19937_64& random) {
    const dvec3 helper = std::abs(normal.x) > 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    const dvec3 t = glm::normalize(glm::cross(helper, normal)), b = glm::cross(normal, t);
    const dvec3 wo(-glm::dot(d, t), -glm::dot(d, b), std::max(-glm::dot(d, normal), 1e-9));
    // An extremely high index reflects everything, which models white metal.
    const double eta = !glass ? 1e9 : inside ? 1.0 / index : index;
    const double alpha = std::max(roughness * roughness, 1e-4);
    const dvec3 out = test::walkDielectric(glm::normalize(wo), alpha, eta, random).direction;
    if (out.z < 0.0) inside = !inside;
    return glm::normalize(out.x * t + out.y * b + out.z * normal);
}

/// Returns the radiance along one path from o; spheres stand side by side on the X axis, one unit apart.
dvec3 trace(dvec3 o, const Material& material, const Sky& sky, std::mt19937_64& random) {
    dvec3 d(0, 0, -1);
    bool inside = false;
    int last = -1;
    for (int bounce = 0; bounce < maxBounces; ++bounce) {
        int hit = -1;
        double nearest = 1e30;
        for (int i = 0; i < spheres; ++i) {
            if ((i == last) != inside) continue;  // a convex sphere cannot be hit twice in a row from outside
            const double distance = distanceTo(dvec3(i - 2.0, 0, 0), o, d, inside);
            if (distance > 1e-9 && distance < nearest) nearest = distance, hit = i;
        }
        if (hit < 0) return sky(d);
        o += nearest * d;
        const dvec3 normal = glm::normalize(o - dvec3(hit - 2.0, 0, 0)) * (inside ? -1.0 : 1.0);
        d = scatter(normal, d, material.roughness[static_cast<size_t>(hit)], material.glass, inside, random);
        last = hit;
    }
    return dvec3(0.0);
}

double meanOfSquare(int sphere, const Material& material, const Sky& sky) {
    std::array<double, side> rows{};
    tbb::parallel_for(0, side, [&](int j) {
        std::mt19937_64 random(static_cast<uint64_t>(sphere * side + j));
        std::uniform_real_distribution<double> uniform;
        for (int i = 0; i < side; ++i) {
            const dvec3 from(sphere - 2.5 + (i + uniform(random)) / side, -0.5 + (j + uniform(random)) / side,
                             5);
            const dvec3 radiance = trace(from, material, sky, random);
            rows[static_cast<size_t>(j)] += (radiance.x + radiance.y + radiance.z) / (3.0 * side * side);
        }
    });
    double sum = 0.0;
    for (const double row : rows) sum += row;
    return sum;
}

double meanOfSquare(int sphere, const image::Image& picture) {
    const uint32_t width = picture.width / spheres;
    double sum = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y) {
        for (uint32_t x = 3 * width * static_cast<uint32_t>(sphere);
             x < 3 * width * (static_cast<uint32_t>(sphere) + 1); ++x)
            sum += double{picture.pixels[size_t{3} * y * picture.width + x]};
    }
    return sum / (3.0 * width * picture.height);
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3) {
        fmt::print(stderr, "limpid_walk_row SKY.exr glass|metal [PICTURE.exr]...\n");
        return 2;
    }
    const Sky sky(arguments[1]);
    const bool glass = std::string_view(arguments[2]) == "glass";
    const Material material{glass, {glass ? 0.1 : 0.0, 0.25, 0.5, 0.75, 1.0}};
    for (int sphere = 0; sphere < spheres; ++sphere) {
        const double expected = meanOfSquare(sphere, material, sky);
        fmt::print("{}: {:.4f}", material.roughness[static_cast<size_t>(sphere)], expected);
        for (int i = 3; i < count; ++i)
            fmt::print("  {:.4f}", meanOfSquare(sphere, image::readPicture(arguments[i]).linear) / expected);
        fmt::print("\n");
    }
}
