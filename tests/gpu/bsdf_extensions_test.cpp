// Compares anisotropy, sheen and diffuse transmission with their formulas in double precision, and tests
// their energy and reciprocity.
#include "tests/gpu/bsdf_fixture.h"
#include "tests/reference/bsdf_reference.h"

namespace limpid::test {
namespace {

constexpr float turn = 0.5f;  // of the rougher direction against +X, radians

/// KHR_materials_anisotropy's formulas, from its text: f cos of a metal of this reflectance.
double brushedMetal(const dvec3& wo, const dvec3& wi, double roughness, double strength, double f0) {
    const dvec3 t(std::cos(double{turn}), std::sin(double{turn}), 0.0), b(-t.y, t.x, 0.0);
    const double ab = roughness * roughness, at = ab + (1.0 - ab) * strength * strength;
    const dvec3 h = glm::normalize(wo + wi);
    const dvec3 f(ab * glm::dot(t, h), at * glm::dot(b, h), at * ab * h.z);
    const double w2 = at * ab / glm::dot(f, f), d = at * ab * w2 * w2 / pi64;
    const double v = wi.z * glm::length(dvec3(at * glm::dot(t, wo), ab * glm::dot(b, wo), wo.z));
    const double l = wo.z * glm::length(dvec3(at * glm::dot(t, wi), ab * glm::dot(b, wi), wi.z));
    return schlick(f0, 1.0, glm::dot(wo, h)) * d * 0.5 / (v + l) * wi.z;
}

/// Conty Estevez and Kulla's fit, from KHR_materials_sheen's text.
double sheenLambda(double cosine, double alpha) {
    const auto l = [alpha](double x) {
        const double r = (1.0 - alpha) * (1.0 - alpha);
        return std::lerp(21.5473, 25.3245, r) /
                   (1.0 + std::lerp(3.82987, 3.32435, r) * std::pow(x, std::lerp(0.19823, 0.16801, r))) +
               std::lerp(-1.97760, -1.27393, r) * x + std::lerp(-4.32054, -4.85967, r);
    };
    return cosine < 0.5 ? std::exp(l(cosine)) : std::exp(2.0 * l(0.5) - l(1.0 - cosine));
}

/// f cos of the extension's formula, before it is held at an albedo of 1.
double sheenOf(const dvec3& wo, const dvec3& wi, double roughness) {
    const double alpha = roughness * roughness;
    const dvec3 h = glm::normalize(wo + wi);
    const double d = (2.0 + 1.0 / alpha) * std::pow(1.0 - h.z * h.z, 0.5 / alpha) / (2.0 * pi64);
    return d / (4.0 * wo.z * (1.0 + sheenLambda(wo.z, alpha) + sheenLambda(wi.z, alpha)));
}

dvec3 directionOf(double cosine, double phi) {
    const double sine = std::sqrt(1.0 - cosine * cosine);
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

double sheenAlbedo(double cosine, double roughness) {
    constexpr int steps = 100;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double root = (i + 0.5) / steps;
        for (int k = 0; k < steps; ++k)
            sum += sheenOf(directionOf(cosine, 0.0), directionOf(root * root, pi64 * (k + 0.5) / steps),
                           roughness) *
                   2.0 * root;
    }
    return sum * 2.0 * pi64 / (steps * steps);
}

class BsdfExtensionsTest : public BsdfTest {
  protected:
    static std::vector<vec3> someDirections(int count = 400) {
        std::vector<vec3> directions;
        for (int i = 0; i < count; ++i) {
            const double z = 1.0 - 2.0 * (i + 0.5) / count;
            if (std::abs(z) > 0.05) directions.emplace_back(vec3(directionOf(z, i * 2.399963229728653)));
        }
        return directions;
    }

    static std::vector<NamedMaterial> whiteMaterials() {
        const auto sheen = [](BsdfParams p, float roughness) {
            p.sheenColor = vec3(1.0f);
            p.sheenRoughness = roughness;
            return p;
        };
        return {{"brushed metal", {.metallic = 1.0f, .roughness = 0.2f, .anisotropy = 0.8f}},
                {"brushed plastic", {.roughness = 0.1f, .anisotropy = 1.0f}},
                {"brushed rough plastic", {.roughness = 0.5f, .anisotropy = 0.5f}},
                {"brushed pane", {.roughness = 0.3f, .transmission = 1.0f, .anisotropy = 0.6f}},
                {"brushed glass", {.roughness = 0.3f, .transmission = 1.0f, .thin = 0, .anisotropy = 0.6f}},
                {"sharp sheen on white", sheen({.specular = 0.0f}, 0.07f)},
                {"sheen on plastic", sheen({.roughness = 0.4f}, 0.3f)},
                {"rough sheen on metal", sheen({.metallic = 1.0f, .roughness = 0.4f}, 1.0f)},
                {"translucent plastic", {.roughness = 0.4f, .diffuseTransmission = 0.6f}},
                {"translucent", {.specular = 0.0f, .diffuseTransmission = 1.0f}}};
    }

    /// f without its cosine, of light from wi to wo. The surface is seen from wo's side.
    double valueOf(BsdfParams params, const vec3& wo, const vec3& wi) {
        params.toViewer = wo;
        params.front = wo.z > 0.0f;
        params.normal = params.geometricNormal = params.clearcoatNormal = {0, 0, wo.z > 0.0f ? 1.0f : -1.0f};
        const EvaluatedDirection e = evaluate(params, {wi}).at(0);
        return (double{e.diffuse.r} + double{e.specular.r}) / std::abs(double{wi.z});
    }
};

TEST_F(BsdfExtensionsTest, AnisotropicMetal) {
    double worst = 0.0;
    for (const float strength : {0.3f, 0.7f, 1.0f}) {
        for (const float roughness : {0.15f, 0.5f}) {
            BsdfParams params{.baseColor = {0.9f, 0.6f, 0.3f}, .metallic = 1.0f, .roughness = roughness};
            params.anisotropy = strength;
            params.anisotropyDirection = {std::cos(turn), std::sin(turn), 0.0f};
            for (const float cosine : {0.9f, 0.3f}) {
                params.toViewer = viewerAt(cosine);
                const std::vector<vec3> directions = someDirections();
                const std::vector<EvaluatedDirection> values = evaluate(params, directions);
                for (size_t i = 0; i < directions.size(); ++i) {
                    for (int k = 0; k < 3; ++k) {
                        const double expected =
                            directions[i].z <= 0.0f
                                ? 0.0
                                : brushedMetal(dvec3(params.toViewer), dvec3(directions[i]),
                                               double{roughness}, double{strength},
                                               double{params.baseColor[k]});
                        const double error = std::abs(values[i].specular[k] - expected) / (expected + 1e-3);
                        worst = std::max(worst, error);
                        ASSERT_LT(error, 1e-3) << describe({"brushed", params}) << " direction " << i;
                    }
                }
            }
        }
    }
    fmt::print("anisotropy: within {:.2g} of the formula\n", worst);
}

TEST_F(BsdfExtensionsTest, SheenOverALambertianBase) {
    double worst = 0.0;
    for (const float roughness : {0.1f, 0.4f, 0.9f}) {
        BsdfParams params{.baseColor = {0.8f, 0.4f, 0.1f}, .specular = 0.0f};
        params.sheenColor = {0.5f, 0.9f, 0.2f};
        params.sheenRoughness = roughness;
        for (const float cosine : {0.9f, 0.3f, 0.06f}) {
            params.toViewer = viewerAt(cosine);
            const double outside = sheenAlbedo(double{cosine}, double{roughness});
            const std::vector<vec3> directions = someDirections(100);
            const std::vector<EvaluatedDirection> values = evaluate(params, directions);
            for (size_t i = 0; i < directions.size(); ++i) {
                const dvec3 wi(directions[i]);
                const bool above = wi.z > 0.0;
                const double most = std::max(outside, sheenAlbedo(std::abs(wi.z), double{roughness}));
                const double lobe =
                    above ? sheenOf(dvec3(params.toViewer), wi, double{roughness}) / std::max(most, 1.0)
                          : 0.0;
                const double left = 1.0 - 0.9 * std::min(most, 1.0);
                for (int k = 0; k < 3; ++k) {
                    const double sheen = double{params.sheenColor[k]} * lobe;
                    const double base = above ? double{params.baseColor[k]} * wi.z / pi64 * left : 0.0;
                    // The table is interpolated.
                    const double error = std::max(std::abs(values[i].specular[k] - sheen) / (sheen + 0.05),
                                                  std::abs(values[i].diffuse[k] - base) / (base + 0.05));
                    worst = std::max(worst, error);
                    ASSERT_LT(error, 0.02) << describe({"sheen", params}) << " direction " << i;
                }
            }
        }
    }
    fmt::print("sheen: within {:.2g} of the formula\n", worst);
}

TEST_F(BsdfExtensionsTest, DiffuseTransmission) {
    BsdfParams params{.baseColor = {0.8f, 0.4f, 0.1f}, .specular = 0.0f};
    params.diffuseTransmission = 0.3f;
    params.diffuseTransmissionColor = {0.2f, 0.9f, 0.5f};
    params.toViewer = viewerAt(0.4f);
    const std::vector<vec3> directions = someDirections();
    const std::vector<EvaluatedDirection> values = evaluate(params, directions);
    for (size_t i = 0; i < directions.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            const bool above = directions[i].z > 0.0f;
            const double albedo =
                above ? 0.7 * double{params.baseColor[k]} : 0.3 * double{params.diffuseTransmissionColor[k]};
            EXPECT_NEAR(values[i].diffuse[k], albedo * std::abs(double{directions[i].z}) / pi64, 1e-6);
            EXPECT_EQ(values[i].specular[k], 0.0f);
        }
    }
}

/// White materials return at most all light: exactly all if they only transmit diffusely, less with
/// anisotropy, whose multiple scattering is missing, and with sheen, whose share is that of the more grazing
/// of two directions.
TEST_F(BsdfExtensionsTest, NoEnergyIsGained) {
    for (const NamedMaterial& material : whiteMaterials()) {
        fmt::print("{}: albedo", material.name);
        for (const float cosine : {0.98f, 0.6f, 0.3f, 0.1f, 0.04f}) {
            BsdfParams params = material.params;
            params.toViewer = viewerAt(cosine);
            const double albedo = integrate(params).integral().f;
            fmt::print(" {:.4f}", albedo);
            EXPECT_LT(albedo, 1.003) << describe({material.name, params});
            if (params.diffuseTransmission > 0.0f) {
                EXPECT_NEAR(albedo, 1.0, 0.01) << describe({material.name, params});
            }
        }
        fmt::print("\n");
    }
}

TEST_F(BsdfExtensionsTest, Reciprocity) {
    for (const NamedMaterial& material : whiteMaterials()) {
        if (material.params.transmission > 0.0f)
            continue;  // the lobes of glass are scaled by the viewer's side
        for (const auto& [cosine, other] :
             {std::pair(0.9, 0.2), std::pair(0.35, 0.6), std::pair(0.1, 0.15)}) {
            for (const double side : {1.0, -1.0}) {
                const vec3 a(directionOf(cosine, 0.4)), b(directionOf(side * other, 2.1));
                const double there = valueOf(material.params, a, b), back = valueOf(material.params, b, a);
                EXPECT_NEAR(there, back, 1e-3 * std::max(there, back) + 1e-6)
                    << material.name << ", cosines " << cosine << " and " << side * other;
            }
        }
    }
}

}  // namespace
}  // namespace limpid::test
