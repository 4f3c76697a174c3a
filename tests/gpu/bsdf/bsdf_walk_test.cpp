// Compares the BSDF with a random walk on microfacets (microfacet_walk.h).
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <functional>

#include "scene/device/tables/dielectric_table.h"
#include "tests/gpu/bsdf/bsdf_fixture.h"
#include "tests/reference/bsdf_reference.h"
#include "tests/reference/microfacet_walk.h"

namespace limpid::test {
namespace {

dvec3 directionAt(double cosine, double azimuth = 0.0) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

BsdfParams roughGlass(double roughness, double ior, bool front, double cosine) {
    return {.baseColor = vec3(1.0f),
            .toViewer = vec3(directionAt(cosine)),
            .roughness = static_cast<float>(roughness),
            .ior = static_cast<float>(ior),
            .transmission = 1.0f,
            .thin = 0,
            .front = front};
}

class BsdfWalkTest : public BsdfTest {
  protected:
    /// Returns reflection (x) and transmission (y) of uniform light, by sampling.
    glm::dvec2 energy(const BsdfParams& params, uint32_t count) {
        glm::dvec2 sum(0.0);
        for (const SampledDirection& s : sample(params, count)) {
            if (s.valid) (s.direction.z > 0.0f ? sum.x : sum.y) += double{s.specular.r} / double{s.pdf};
        }
        return sum / static_cast<double>(count);
    }
};

/// A boundary between equal indices has no effect: light goes straight through, whatever the roughness. Just
/// above that, where facets begin to refract, no energy is lost either.
TEST_F(BsdfWalkTest, EqualIndicesLetLightStraightThrough) {
    for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f}) {
        for (const double cosine : {1.0, 0.5, 0.01}) {
            for (const bool front : {true, false}) {
                const BsdfParams params = roughGlass(double{roughness}, 1.0, front, cosine);
                for (const SampledDirection& s : sample(params, 256)) {
                    ASSERT_TRUE(s.valid && s.delta) << "roughness " << roughness << " cosine " << cosine;
                    ASSERT_LT(glm::length(s.direction + params.toViewer), 1e-5f);
                    ASSERT_NEAR(s.specular.r / s.pdf, 1.0f, 1e-5f);
                }
            }
        }
    }
    for (const double ior : {1.0009, 1.0011, 1.003, 1.01}) {
        for (const bool front : {true, false}) {
            for (const double cosine : {1.0, 0.5, 0.2}) {
                const glm::dvec2 found = energy(roughGlass(0.5, ior, front, cosine), 1u << 14);
                EXPECT_NEAR(found.x + found.y, 1.0, 0.02)
                    << "ior " << ior << " front " << front << " cosine " << cosine;
            }
        }
    }
}

/// Glass seen from one side at one angle, and the walk's reflection and transmission there.
struct GlassCase {
    double ior, roughness, cosine;
    bool front;
    DielectricEnergy expected{};
};

std::vector<GlassCase> walkThroughGlass() {
    std::vector<GlassCase> cases;
    for (const double ior : {1.05, 1.33, 1.5, 2.4}) {
        for (const bool front : {true, false}) {
            for (const double roughness : {0.25, 0.5, 0.75, 1.0})
                for (const double cosine : {0.1, 0.3, 0.6, 1.0})
                    cases.push_back({ior, roughness, cosine, front});
        }
    }
    tbb::parallel_for(size_t{0}, cases.size(), [&](size_t i) {
        GlassCase& c = cases[i];
        const double eta = c.front ? c.ior : 1.0 / c.ior;
        c.expected = dielectricEnergy(c.cosine, c.roughness * c.roughness, eta, 120000, i + 1);
    });
    return cases;
}

/// Reflection and transmission each match within 1 % of the incident light.
TEST_F(BsdfWalkTest, RoughGlassReflectsAndTransmitsAsTheWalkDoes) {
    glm::dvec2 worst(0.0);
    for (const GlassCase& c : walkThroughGlass()) {
        const glm::dvec2 found = energy(roughGlass(c.roughness, c.ior, c.front, c.cosine), 1u << 18);
        const glm::dvec2 expected(c.expected.reflected, c.expected.transmitted);
        const glm::dvec2 off = glm::abs(found - expected);
        worst = glm::max(worst, off);
        EXPECT_LT(std::max(off.x, off.y), 0.01) << fmt::format(
            "ior {} front {} roughness {} cosine {}: reflects {:.4f}, transmits {:.4f}; the walk "
            "{:.4f} and {:.4f}",
            c.ior, c.front, c.roughness, c.cosine, found.x, found.y, expected.x, expected.y);
    }
    fmt::print("rough glass: reflection off by {:.4f}, transmission by {:.4f} at worst\n", worst.x, worst.y);
}

/// The table in the repository matches its generator: compares some entries with other walks.
TEST(DielectricShare, TableIsThatOfTheWalk) {
    const std::vector<vec2> disk = scene::halfDisk(1u << 12);
    for (uint32_t node = 5; node < scene::share::count; node += 131) {
        using namespace scene::share;
        const float index = eta(node / (cosines * roughnesses));
        const float c = cosine(node % cosines, index), r = roughness(node / cosines % roughnesses);
        const scene::FirstFacet first = scene::firstFacet(c, r * r, index, disk);
        const double stored = double{first.reflectedOnce} +
                              double{first.missing()} * double{scene::reflectedShare(c, r, index)};
        const DielectricEnergy walked =
            dielectricEnergy(double{c}, double{r * r}, double{index}, 20000, 1000 + node);
        EXPECT_NEAR(walked.reflected, stored, 0.015)
            << "cosine " << c << " roughness " << r << " eta " << index;
    }
}

/// A sphere of metal at roughness 1 seen from far away: mean radiance over rings of 10 degrees of the angle
/// between normal and view direction, weighted by the area in the picture. Lights: a distant one at the
/// viewer, a distant one 60 degrees off, and the half of the sky behind the viewer. Each must match the walk
/// within 2 %.
class MetalSphereTest : public BsdfWalkTest {
  protected:
    static constexpr int anglesPerRing = 2, azimuths = 8;
    static constexpr std::array<double, 4> f0{1.0, 0.95, 0.6, 0.25};
    using Radiance = std::array<glm::dvec4, 9>;
    using Shade = std::function<glm::dvec4(double cosine)>;

    static Radiance overRings(const Shade& shade) {
        Radiance rings{};
        for (size_t ring = 0; ring < rings.size(); ++ring) {
            double area = 0.0;
            for (int i = 0; i < anglesPerRing; ++i) {
                const double angle = (static_cast<double>(ring) + (i + 0.5) / anglesPerRing) * pi64 / 18.0;
                const double weight = std::sin(angle) * std::cos(angle);
                rings[ring] += weight * shade(std::cos(angle));
                area += weight;
            }
            rings[ring] /= area;
        }
        return rings;
    }

    /// Returns f cos for the four metals: three of them in one colour's channels, the fourth in another.
    std::vector<glm::dvec4> evaluateMetals(double cosine, const std::vector<vec3>& directions) {
        std::vector<glm::dvec4> values(directions.size());
        for (const auto& [colour, at] : {std::pair{vec3(1.0f, 0.95f, 0.6f), 0}, std::pair{vec3(0.25f), 3}}) {
            const BsdfParams params{.baseColor = colour,
                                    .metallic = 1.0f,
                                    .toViewer = vec3(directionAt(cosine)),
                                    .roughness = 1.0f};
            const std::vector<EvaluatedDirection> found = evaluate(params, directions);
            for (size_t i = 0; i < found.size(); ++i)
                for (int k = at; k < (at == 0 ? 3 : 4); ++k) values[i][k] = double{found[i].specular[k - at]};
        }
        return values;
    }

    static glm::dvec4 walkTowards(double cosine, const std::vector<dvec3>& directions) {
        const dvec3 wo = directionAt(cosine);
        const std::vector<double> several = metalMultiple(wo, 1.0, f0, directions, 12000, 11);
        glm::dvec4 sum(0.0);
        for (size_t i = 0; i < directions.size(); ++i) {
            for (size_t k = 0; k < f0.size(); ++k) {
                sum[static_cast<int>(k)] +=
                    (several[i * f0.size() + k] + reflected(wo, directions[i], 1.0, f0[k], 1.0)) /
                    static_cast<double>(directions.size());
            }
        }
        return sum;
    }

    /// Returns directions to a distant light that is `offset` radians off the viewer, for points around a
    /// ring. Unlit points are skipped on both sides of the comparison.
    static std::vector<dvec3> lightsAround(double cosine, double offset) {
        std::vector<dvec3> directions;
        const dvec3 v = directionAt(cosine), up(-v.z, 0.0, v.x), side(0, 1, 0);
        for (int i = 0; i < azimuths; ++i) {
            const double azimuth = (i + 0.5) * pi64 / azimuths;
            const dvec3 around = std::cos(azimuth) * up + std::sin(azimuth) * side;
            const dvec3 light = std::cos(offset) * v + std::sin(offset) * around;
            if (light.z > 0.01) directions.push_back(light);
            if (offset == 0.0) break;
        }
        return directions;
    }

    void compare(const char* name, const Radiance& found, const Radiance& expected) {
        glm::dvec4 worst(0.0);
        for (size_t ring = 0; ring < found.size(); ++ring) {
            const glm::dvec4 off = glm::abs(found[ring] / expected[ring] - 1.0);
            worst = glm::max(worst, off);
            for (int k = 0; k < 4; ++k) {
                EXPECT_LT(off[k], 0.02) << name << ", F0 " << f0[static_cast<size_t>(k)] << ", ring " << ring
                                        << ": " << found[ring][k] << ", the walk " << expected[ring][k];
            }
        }
        fmt::print("{}: off by {:.3f} {:.3f} {:.3f} {:.3f} at worst\n", name, worst.x, worst.y, worst.z,
                   worst.w);
    }

    void compareDistant(const char* name, double offset) {
        const Radiance found = overRings([&](double cosine) {
            const std::vector<dvec3> lights = lightsAround(cosine, offset);
            glm::dvec4 sum(0.0);
            for (const glm::dvec4& value : evaluateMetals(cosine, {lights.begin(), lights.end()}))
                sum += value;
            return sum / static_cast<double>(lights.size());
        });
        compare(name, found,
                overRings([&](double cosine) { return walkTowards(cosine, lightsAround(cosine, offset)); }));
    }
};

TEST_F(MetalSphereTest, LitFromTheViewer) {
    compareDistant("lit from the viewer", 0.0);
}

TEST_F(MetalSphereTest, LitFromTheSide) {
    compareDistant("lit from 60 degrees off", pi64 / 3.0);
}

TEST_F(MetalSphereTest, LitByHalfTheSky) {
    constexpr int rows = 64, columns = 128;
    const Radiance found = overRings([&](double cosine) {
        std::vector<vec3> directions;
        const dvec3 v = directionAt(cosine);
        for (int i = 0; i < rows * columns; ++i) {
            const dvec3 d =
                directionAt((i / columns + 0.5) / rows, (i % columns + 0.5) * 2.0 * pi64 / columns);
            if (glm::dot(d, v) > 0.0) directions.emplace_back(d);
        }
        glm::dvec4 sum(0.0);
        for (const glm::dvec4& value : evaluateMetals(cosine, directions)) sum += value;
        return sum * (2.0 * pi64 / (rows * columns));
    });
    compare("lit by half the sky", found, overRings([&](double cosine) {
                const dvec3 wo = directionAt(cosine);
                const std::vector<double> e = metalEnergy(wo, 1.0, f0, wo, 60000, 12);
                return glm::dvec4(e[0], e[1], e[2], e[3]);
            }));
}

/// Checks the walk itself: white metal loses no energy, and one facet reflects what the formula says.
TEST(MicrofacetWalk, KeepsEnergyAndAgreesWithTheFormula) {
    constexpr std::array<double, 1> white{1.0};
    for (const double cosine : {0.1, 0.5, 0.9}) {
        const dvec3 wo = directionAt(cosine);
        EXPECT_NEAR(metalEnergy(wo, 1.0, white, {0, 0, 1}, 5000, 1)[0], 1.0, 1e-3);
        double once = 0.0;
        constexpr int rows = 100, columns = 100;
        for (int i = 0; i < rows * columns; ++i) {
            const dvec3 wi =
                directionAt((i / columns + 0.5) / rows, (i % columns + 0.5) * 2.0 * pi64 / columns);
            once += reflected(wo, wi, 0.5, 1.0, 1.0) * 2.0 * pi64 / (rows * columns);
        }
        // Such a high refractive index reflects almost everything.
        const DielectricEnergy mirror = dielectricEnergy(cosine, 0.5, 1e6, 20000, 2);
        EXPECT_NEAR(mirror.reflectedOnce, once, 0.015) << "cosine " << cosine;
    }
}

/// Scattering by two facets or more is the same from wo to wi as from wi to wo.
TEST(MicrofacetWalk, IsReciprocal) {
    constexpr std::array<double, 1> white{1.0};
    const dvec3 a = directionAt(0.3), b = directionAt(0.8, 1.0);
    const double there = metalMultiple(a, 0.6, white, std::array{b}, 40000, 3)[0] / b.z;
    const double back = metalMultiple(b, 0.6, white, std::array{a}, 40000, 4)[0] / a.z;
    EXPECT_NEAR(there / back, 1.0, 0.05);
}

}  // namespace
}  // namespace limpid::test
