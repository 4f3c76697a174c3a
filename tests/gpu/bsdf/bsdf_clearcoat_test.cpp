// Compares the clear coat (shaders/material/clearcoat.glsl) with its formula in double precision, with its
// own normal.
#include <functional>

#include "tests/gpu/bsdf/bsdf_fixture.h"
#include "tests/reference/bsdf_reference.h"

namespace limpid::test {
namespace {

using glm::dmat3;

dmat3 frameAround(const dvec3& n) {
    const dvec3 t = glm::normalize(glm::cross(std::abs(n.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), n));
    return {t, glm::cross(n, t), n};
}

class ClearcoatTest : public BsdfTest {
  protected:
    /// Returns the coat's reflection of uniform light, including its weight.
    double albedoOf(const BsdfParams& p, double cosine) const {
        if (p.clearcoatRoughness < layout::SMOOTH_ROUGHNESS)
            return double{p.clearcoat} * schlick(0.04, 1.0, cosine);
        const glm::dvec4 table = ggxTable(data().ggxTable, cosine, double{p.clearcoatRoughness});
        return double{p.clearcoat} * (0.04 * table.x + table.y);
    }

    static double coatOf(const BsdfParams& p, const dvec3& wo, const dvec3& wi) {
        if (wo.z <= 0.0 || wi.z <= 0.0 || p.clearcoatRoughness < layout::SMOOTH_ROUGHNESS) return 0.0;
        const double alpha = double{p.clearcoatRoughness} * double{p.clearcoatRoughness};
        return double{p.clearcoat} * reflected(wo, wi, alpha, 0.04, 1.0);
    }

    static std::vector<vec3> someDirections() {
        std::vector<vec3> directions;
        for (int i = 0; i < 1000; ++i) {
            const double z = 1.0 - (i + 0.5) / 1000, phi = i * 2.399963229728653, r = std::sqrt(1.0 - z * z);
            if (z > 0.02) directions.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
        }
        return directions;
    }
};

TEST_F(ClearcoatTest, OverALambertianBase) {
    double worst = 0.0;
    for (const float roughness : {0.0f, 0.1f, 0.4f, 1.0f}) {
        for (const vec3& normal : {vec3(0, 0, 1), glm::normalize(vec3(0.2f, -0.1f, 1.0f))}) {
            BsdfParams params{.baseColor = {0.8f, 0.4f, 0.1f}, .specular = 0.0f};
            params.clearcoat = 0.7f;
            params.clearcoatRoughness = roughness;
            params.clearcoatNormal = normal;
            const dmat3 frame = frameAround(dvec3(normal));
            for (const float cosine : {0.95f, 0.5f, 0.3f}) {
                params.toViewer = viewerAt(cosine);
                const dvec3 wo = dvec3(params.toViewer) * frame;
                const std::vector<vec3> directions = someDirections();
                const std::vector<EvaluatedDirection> values = evaluate(params, directions);
                for (size_t i = 0; i < directions.size(); ++i) {
                    const double coat = coatOf(params, wo, dvec3(directions[i]) * frame);
                    const double through = 1.0 - albedoOf(params, wo.z);
                    for (int k = 0; k < 3; ++k) {
                        const double base =
                            double{params.baseColor[k]} * double{directions[i].z} / pi64 * through;
                        const double error = std::max(std::abs(values[i].specular[k] - coat) / (coat + 1e-3),
                                                      std::abs(values[i].diffuse[k] - base) / (base + 1e-3));
                        worst = std::max(worst, error);
                        ASSERT_LT(error, 3e-4) << describe({"coat", params}) << " direction " << i;
                    }
                }
            }
        }
    }
    fmt::print("clear coat: within {:.2g} of the formula\n", worst);
}

/// The energy that the coat keeps from the base equals the energy it reflects.
TEST_F(ClearcoatTest, KeepsFromTheBaseWhatItReflects) {
    for (const float roughness : {0.05f, 0.3f, 0.8f}) {
        for (const float cosine : {0.99f, 0.5f, 0.15f}) {
            BsdfParams black{.baseColor = vec3(0.0f), .specular = 0.0f};
            black.clearcoat = 0.6f;
            black.clearcoatRoughness = roughness;
            black.toViewer = viewerAt(cosine);
            EXPECT_NEAR(integrate(black).integral().f, albedoOf(black, double{cosine}), 3e-3)
                << describe({"black below", black});
        }
    }
}

}  // namespace
}  // namespace limpid::test
