// White furnace: a white surface of any kind returns all light that it receives.
#include <algorithm>
#include <cmath>

#include "tests/gpu/bsdf/bsdf_fixture.h"

namespace limpid::test {
namespace {

class BsdfEnergyTest : public BsdfTest {
  protected:
    /// Uses sampling for smooth lobes, which has hardly any noise there, and quadrature for rough ones, which
    /// has none.
    double albedo(const BsdfParams& params) {
        const bool smoothCoat = params.clearcoat > 0.0f && params.clearcoatRoughness < 0.05f;
        if (params.roughness >= 0.05f && !smoothCoat) return integrate(params).integral().f;
        constexpr uint32_t count = 1u << 16;
        double sum = 0.0;
        for (const SampledDirection& s : sample(params, count)) {
            if (s.valid) sum += (double{s.diffuse.r} + double{s.specular.r}) / double{s.pdf};
        }
        return sum / count;
    }

    void expectWhite(NamedMaterial material, double tolerance,
                     const std::vector<float>& roughnesses = {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
        double worst = 0.0;
        std::string table;
        for (const float roughness : roughnesses) {
            material.params.roughness = roughness;
            table += fmt::format("  roughness {:.1f}:", roughness);
            for (const float cosine : {0.999f, 0.8f, 0.5f, 0.25f, 0.1f}) {
                material.params.toViewer = viewerAt(cosine);
                const double a = albedo(material.params);
                table += fmt::format(" {:.4f}", a);
                EXPECT_NEAR(a, 1.0, tolerance) << describe(material);
                worst = std::max(worst, std::abs(a - 1.0));
            }
            table += '\n';
        }
        fmt::print("{}: albedo at cosines 0.999 0.8 0.5 0.25 0.1, off by {:.2g} at worst\n{}", material.name,
                   worst, table);
    }
};

TEST_F(BsdfEnergyTest, WhiteMetal) {
    expectWhite({"white metal", {.metallic = 1.0f}}, 0.01);
}

TEST_F(BsdfEnergyTest, WhitePlastic) {
    expectWhite({"white plastic", {}}, 0.01);
}

TEST_F(BsdfEnergyTest, WhiteThinGlass) {
    expectWhite({"white pane", {.transmission = 1.0f}}, 0.01);
}

TEST_F(BsdfEnergyTest, WhiteSolidGlassFromOutside) {
    expectWhite({"white glass from outside", {.transmission = 1.0f, .thin = 0}}, 0.01);
}

TEST_F(BsdfEnergyTest, WhiteSolidGlassFromInside) {
    expectWhite({"white glass from inside", {.transmission = 1.0f, .thin = 0, .front = 0}}, 0.01);
}

/// Near an index of 1, total reflection only occurs at grazing angles, which is difficult for a table.
TEST_F(BsdfEnergyTest, WhiteSolidGlassOfOtherIndices) {
    for (const float ior : {1.05f, 1.33f, 2.4f}) {
        for (const uint32_t front : {1u, 0u}) {
            const NamedMaterial glass{fmt::format("white glass of index {}, front {}", ior, front),
                                      {.ior = ior, .transmission = 1.0f, .thin = 0, .front = front}};
            expectWhite(glass, ior < 1.1f ? 0.04 : 0.01, {0.3f, 1.0f});
        }
    }
}

TEST_F(BsdfEnergyTest, WhiteMixture) {
    expectWhite({"white mixture", {.metallic = 0.5f, .transmission = 0.5f}}, 0.01);
    expectWhite({"white solid mixture", {.metallic = 0.2f, .transmission = 0.5f, .thin = 0}}, 0.01);
}

/// A clear coat takes exactly what it reflects from the layers below: white stays white.
TEST_F(BsdfEnergyTest, WhiteBelowAClearCoat) {
    for (const NamedMaterial& base :
         {NamedMaterial{"plastic", {}}, NamedMaterial{"metal", {.metallic = 1.0f}},
          NamedMaterial{"pane", {.transmission = 1.0f}},
          NamedMaterial{"glass", {.transmission = 1.0f, .thin = 0}}}) {
        for (const float roughness : {0.0f, 0.2f, 0.9f}) {
            NamedMaterial coated = base;
            coated.name = fmt::format("white {} below a coat of roughness {}", base.name, roughness);
            coated.params.clearcoat = roughness == 0.2f ? 0.5f : 1.0f;
            coated.params.clearcoatRoughness = roughness;
            expectWhite(coated, 0.01, {0.0f, 0.3f});
        }
    }
}

}  // namespace
}  // namespace limpid::test
