// Compares sampling with density: chi-square tests, normalisation, and albedo by sampling with albedo by
// quadrature.
#include <algorithm>
#include <cmath>

#include "tests/gpu/bsdf/bsdf_fixture.h"
#include "tests/reference/statistics.h"

namespace limpid::test {
namespace {

constexpr uint32_t sampleCount = 1u << 17;

BsdfParams plastic(float roughness, float ior = 1.5f) {
    return {.baseColor = vec3(0.7f), .roughness = roughness, .ior = ior};
}
BsdfParams metal(float roughness) {
    return {.baseColor = {0.9f, 0.6f, 0.3f}, .metallic = 1.0f, .roughness = roughness};
}
BsdfParams pane(float roughness) {
    return {.baseColor = vec3(0.8f), .roughness = roughness, .transmission = 1.0f};
}
BsdfParams glass(float roughness, float ior, bool front) {
    return {.baseColor = vec3(0.9f),
            .roughness = roughness,
            .ior = ior,
            .transmission = 1.0f,
            .thin = 0,
            .front = front};
}
BsdfParams mixture(float roughness, bool thin, bool front) {
    return {.baseColor = {0.8f, 0.5f, 0.2f},
            .metallic = 0.3f,
            .roughness = roughness,
            .ior = 1.8f,
            .transmission = 0.6f,
            .thin = thin,
            .front = front};
}

BsdfParams coated(BsdfParams base, float roughness, float weight = 1.0f) {
    base.clearcoat = weight;
    base.clearcoatRoughness = roughness;
    return base;
}

BsdfParams brushed(BsdfParams base, float strength) {
    base.anisotropy = strength;
    base.anisotropyDirection = {0.8f, 0.6f, 0.0f};
    return base;
}

BsdfParams fibrous(BsdfParams base, float roughness) {
    base.sheenColor = {0.9f, 0.5f, 0.7f};
    base.sheenRoughness = roughness;
    return base;
}

BsdfParams translucent(BsdfParams base, float share) {
    base.diffuseTransmission = share;
    base.diffuseTransmissionColor = {0.9f, 0.6f, 0.4f};
    return base;
}

BsdfParams filmed(BsdfParams base, float nanometres) {
    base.iridescence = 0.9f;
    base.iridescenceThickness = nanometres;
    return base;
}

std::vector<NamedMaterial> materials() {
    return {{"Lambertian", {.baseColor = vec3(0.6f), .specular = 0.0f}},
            {"plastic, sharp", plastic(0.05f)},
            {"plastic", plastic(0.4f)},
            {"plastic, rough, dense", plastic(1.0f, 2.5f)},
            {"plastic, smooth", plastic(0.0f)},
            {"metal, sharpest lobe that is sampled", metal(0.031f)},
            {"metal", metal(0.3f)},
            {"metal, rough", metal(1.0f)},
            {"pane", pane(0.25f)},
            {"pane, rough", pane(0.9f)},
            {"glass from outside, sharp", glass(0.1f, 1.5f, true)},
            {"glass from outside", glass(0.5f, 1.5f, true)},
            {"glass from outside, rough", glass(1.0f, 1.5f, true)},
            {"glass from inside", glass(0.4f, 1.5f, false)},
            {"glass from inside, rough, dense", glass(0.9f, 2.2f, false)},
            {"thin mixture", mixture(0.5f, true, true)},
            {"solid mixture from outside", mixture(0.35f, false, true)},
            {"solid mixture from inside", mixture(0.7f, false, false)},
            {"smooth coat on plastic", coated(plastic(0.4f), 0.0f)},
            {"sharp coat on metal", coated(metal(0.6f), 0.1f)},
            {"rough coat on Lambertian", coated({.baseColor = vec3(0.6f), .specular = 0.0f}, 0.5f, 0.7f)},
            {"rough coat on a mirror", coated(metal(0.0f), 0.4f)},
            {"coat on black", coated({.baseColor = vec3(0.0f), .specular = 0.0f}, 0.3f, 0.4f)},
            {"coat on glass", coated(glass(0.4f, 1.5f, true), 0.2f, 0.8f)},
            {"coat on glass from inside", coated(glass(0.4f, 1.5f, false), 0.2f)},
            {"brushed metal", brushed(metal(0.2f), 0.6f)},
            {"brushed plastic", brushed(plastic(0.3f), 0.9f)},
            {"brushed pane", brushed(pane(0.3f), 0.5f)},
            {"brushed glass", brushed(glass(0.3f, 1.5f, true), 0.7f)},
            {"sheen on plastic", fibrous(plastic(0.5f), 0.4f)},
            {"sharp sheen on a mirror", fibrous(metal(0.0f), 0.15f)},
            {"sheen on glass, coated", coated(fibrous(glass(0.4f, 1.5f, true), 0.8f), 0.3f, 0.6f)},
            {"translucent plastic", translucent(plastic(0.4f), 0.5f)},
            {"translucent smooth plastic", translucent(plastic(0.0f), 1.0f)},
            {"film on plastic", filmed(plastic(0.3f, 1.9f), 350.0f)},
            {"film on metal", filmed(metal(0.6f), 520.0f)},
            {"film on a pane", filmed(pane(0.3f), 300.0f)},
            {"translucent mixture with sheen", fibrous(translucent(mixture(0.4f, false, true), 0.7f), 0.5f)}};
}

struct Totals {
    double tests = 0, smallestP = 1, worstNormalisation = 0, worstAlbedo = 0;
    std::string smallest;
};

class BsdfSamplingTest : public BsdfTest {
  protected:
    void check(const NamedMaterial& material, Totals& totals) {
        SCOPED_TRACE(describe(material));
        const SphereQuadrature quadrature = integrate(material.params);
        const std::vector<SampledDirection> samples = sample(material.params, sampleCount);
        std::vector<double> expected = quadrature.binMasses(), observed(expected.size(), 0.0);
        for (double& e : expected) e *= sampleCount;
        double nowhere = 0.0, sum = 0.0, squares = 0.0;
        for (const SampledDirection& s : samples) {
            if (s.delta || !s.valid) {
                ++nowhere;
                continue;
            }
            ++observed[quadrature.binOf(s.direction)];
            const double weight = (double{s.diffuse.r} + double{s.specular.r}) / double{s.pdf};
            sum += weight;
            squares += weight * weight;
        }
        checkNormalisation(quadrature.integral().pdf, nowhere, totals);
        checkAlbedo(quadrature.integral().f, sum / sampleCount, squares / sampleCount, totals);
        observed.push_back(nowhere);
        expected.push_back(std::max(0.0, sampleCount * (1.0 - quadrature.integral().pdf)));
        checkBins(chiSquare(observed, expected), material, totals);
    }

  private:
    /// The density's difference from 1 must equal the share of samples that are invalid or from a smooth
    /// lobe.
    void checkNormalisation(double integral, double nowhere, Totals& totals) {
        const double lacking = 1.0 - integral;
        const double sigma = std::sqrt(std::max(lacking * integral, 1e-9) / sampleCount);
        const double difference = std::abs(nowhere / sampleCount - lacking);
        EXPECT_LT(difference, 4.5 * sigma + 5e-4)
            << "the density adds up to " << integral << ", of the samples " << nowhere / sampleCount
            << " were invalid or smooth";
        totals.worstNormalisation = std::max(totals.worstNormalisation, difference);
    }

    void checkAlbedo(double integral, double mean, double meanSquare, Totals& totals) {
        const double sigma = std::sqrt(std::max(meanSquare - mean * mean, 0.0) / sampleCount);
        EXPECT_LT(std::abs(mean - integral), 4.5 * sigma + 1e-3)
            << "albedo by quadrature " << integral << ", by sampling " << mean << " +- " << sigma;
        EXPECT_LE(integral, 1.005);
        totals.worstAlbedo = std::max(totals.worstAlbedo, std::abs(mean - integral));
    }

    void checkBins(const ChiSquare& result, const NamedMaterial& material, Totals& totals) {
        ++totals.tests;
        if (result.p < totals.smallestP) {
            totals.smallestP = result.p;
            totals.smallest = describe(material);
        }
        // 1e-3 in total, over about a hundred tests.
        EXPECT_GT(result.p, 1e-3 / 100) << "chi-square " << result.statistic << " with "
                                        << result.degreesOfFreedom << " degrees of freedom; " << result.worst;
    }
};

TEST_F(BsdfSamplingTest, DirectionsFollowTheDensity) {
    Totals totals;
    uint32_t seed = 1;
    for (NamedMaterial material : materials()) {
        for (const float cosine : {0.97f, 0.5f, 0.08f}) {
            material.params.toViewer = viewerAt(cosine);
            material.params.seed = seed++;
            check(material, totals);
        }
    }
    RecordProperty("summary", fmt::format("{} tests, smallest p {}", totals.tests, totals.smallestP));
    fmt::print(
        "chi-square: {} tests, smallest p {:.2g} ({}); normalisation within {:.2g}, albedo within {:.2g}\n",
        totals.tests, totals.smallestP, totals.smallest, totals.worstNormalisation, totals.worstAlbedo);
}

/// With a shading normal that differs from the geometric one, directions that would leave on the wrong side
/// are invalid.
TEST_F(BsdfSamplingTest, TiltedShadingNormal) {
    Totals totals;
    for (NamedMaterial material : {NamedMaterial{"tilted plastic", plastic(0.4f)},
                                   NamedMaterial{"tilted glass", glass(0.5f, 1.5f, true)}}) {
        material.params.normal = glm::normalize(vec3(0.3f, -0.2f, 0.9f));
        material.params.toViewer = viewerAt(0.6f);
        material.params.seed = 77;
        check(material, totals);
    }
}

/// Tests the coat's own normal, with the base's normal upright or tilted differently.
TEST_F(BsdfSamplingTest, TiltedClearcoatNormal) {
    Totals totals;
    for (const vec3& normal : {vec3(0, 0, 1), glm::normalize(vec3(-0.2f, 0.3f, 0.9f))}) {
        for (const float cosine : {0.6f, 0.25f}) {
            NamedMaterial material{"tilted coat", coated(plastic(0.4f), 0.3f)};
            material.params.normal = normal;
            material.params.clearcoatNormal = glm::normalize(vec3(0.3f, 0.2f, 0.9f));
            material.params.toViewer = viewerAt(cosine);
            material.params.seed = 78;
            check(material, totals);
        }
    }
}

}  // namespace
}  // namespace limpid::test
