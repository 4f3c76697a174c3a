// Compares anisotropy, sheen and diffuse transmission with their formulas in double precision, and tests
// their energy and reciprocity.
#include "tests/gpu/bsdf/bsdf_fixture.h"
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

/// What a film makes of the light that its surface reflects.
struct Film {
    dvec3 reflectance;
    double omitted;  ///< bound of what a sum over reflections in the film lacks that ends after two
};

/// The reflectance below a thin film, by Airy's formula (M. Born, E. Wolf, "Principles of Optics",
/// section 7.6) for Schlick's reflectances, integrated over wave numbers with the colour matching functions
/// of Belcour and Barla. The constant part is white, as in KHR_materials_iridescence.
Film filmReflectance(double cosine, double ior, double nanometres, double f0) {
    const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (ior * ior));
    const double base = (1.0 + std::sqrt(f0)) / (1.0 - std::sqrt(f0));
    const auto amplitude = [](double in, double out, double c) {
        const double r = schlick(std::pow((out - in) / (out + in), 2.0), 1.0, c);
        return out > in ? -std::sqrt(r) : std::sqrt(r);
    };
    const double a = amplitude(1.0, ior, cosine), b = amplitude(ior, base, inside);
    const double mean = a * a + std::pow(1.0 - a * a, 2.0) * b * b / (1.0 - a * a * b * b);
    const double path = 2.0 * ior * nanometres * 1e-9 * inside;
    dvec3 xyz(0.0);
    constexpr int waves = 3000;
    constexpr double step = 1000.0;  // per metre
    for (int i = 0; i < waves; ++i) {
        const double wave = 0.5e6 + i * step;
        const auto gauss = [wave](double value, double position, double variance) {
            return value / std::sqrt(2.0) * std::exp(-std::pow(wave - position, 2.0) / (4.0 * variance));
        };
        const double c = std::cos(2.0 * pi64 * path * wave);
        const double r = (a * a + b * b + 2.0 * a * b * c) / (1.0 + a * a * b * b + 2.0 * a * b * c);
        const dvec3 eye(gauss(5.4856e-13, 1.6810e6, 4.3278e9) + gauss(9.7470e-14, 2.2399e6, 4.5282e9),
                        gauss(4.4201e-13, 1.7953e6, 9.3046e9), gauss(5.2481e-13, 2.2084e6, 6.6121e9));
        xyz += eye * ((r - mean) * step / 1.0685e-7);
    }
    const dvec3 rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                    -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                    0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    const double order = std::abs(a * b), first = std::abs(mean - 1.0);
    return {glm::clamp(rgb + mean, 0.0, 1.0), 2.5 * first * std::pow(order, 3.0) / (1.0 - order)};
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
        return {
            {"brushed metal", {.metallic = 1.0f, .roughness = 0.2f, .anisotropy = 0.8f}},
            {"brushed plastic", {.roughness = 0.1f, .anisotropy = 1.0f}},
            {"brushed rough plastic", {.roughness = 0.5f, .anisotropy = 0.5f}},
            {"brushed pane", {.roughness = 0.3f, .transmission = 1.0f, .anisotropy = 0.6f}},
            {"brushed glass", {.roughness = 0.3f, .transmission = 1.0f, .thin = 0, .anisotropy = 0.6f}},
            {"sharp sheen on white", sheen({.specular = 0.0f}, 0.07f)},
            {"sheen on plastic", sheen({.roughness = 0.4f}, 0.3f)},
            {"rough sheen on metal", sheen({.metallic = 1.0f, .roughness = 0.4f}, 1.0f)},
            {"film on plastic", {.roughness = 0.3f, .iridescence = 1.0f}},
            {"film on dense plastic",
             {.roughness = 0.1f, .ior = 2.2f, .iridescence = 1.0f, .iridescenceThickness = 250.0f}},
            {"strong film on smooth plastic",
             {.roughness = 0.1f, .iridescence = 1.0f, .iridescenceIor = 2.4f, .iridescenceThickness = 60.0f}},
            {"strong film on rough plastic",
             {.roughness = 0.8f,
              .iridescence = 1.0f,
              .iridescenceIor = 2.0f,
              .iridescenceThickness = 600.0f}},
            {"film on metal", {.metallic = 1.0f, .roughness = 0.6f, .iridescence = 1.0f}},
            {"film on a pane", {.roughness = 0.2f, .transmission = 1.0f, .iridescence = 1.0f}},
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

TEST_F(BsdfExtensionsTest, AFilmInterferes) {
    double worst = 0.0;
    for (const float nanometres : {120.0f, 300.0f, 700.0f}) {
        for (const float metallic : {0.0f, 1.0f}) {
            BsdfParams params{.baseColor = vec3(metallic * 0.7f), .metallic = metallic, .roughness = 0.3f};
            params.anisotropy = 0.5f;  // so that the metal has no multiple scattering
            params.anisotropyDirection = {std::cos(turn), std::sin(turn), 0.0f};
            params.iridescence = 1.0f;
            params.iridescenceIor = 1.7f;
            params.iridescenceThickness = nanometres;
            params.toViewer = viewerAt(0.7f);
            const dvec3 wo(params.toViewer);
            const std::vector<vec3> directions = someDirections(100);
            const std::vector<EvaluatedDirection> values = evaluate(params, directions);
            for (size_t i = 0; i < directions.size(); ++i) {
                const dvec3 wi(directions[i]);
                if (wi.z < 0.0) continue;
                const double cosine = glm::dot(wo, glm::normalize(wo + wi));
                const Film film =
                    filmReflectance(cosine, 1.7, double{nanometres}, metallic > 0.0f ? double{0.7f} : 0.04);
                const double lobe = brushedMetal(wo, wi, double{0.3f}, 0.5, 1.0);
                for (int k = 0; k < 3; ++k) {
                    const double error = std::abs(values[i].specular[k] / lobe - film.reflectance[k]);
                    worst = std::max(worst, error);
                    ASSERT_LT(error, film.omitted + 2e-3)
                        << describe({"film", params}) << " direction " << i << " channel " << k;
                }
            }
        }
    }
    fmt::print("film: reflectance within {:.2g}\n", worst);
}

/// A film of no thickness is none.
TEST_F(BsdfExtensionsTest, AFilmFadesAway) {
    BsdfParams params{.baseColor = {0.6f, 0.5f, 0.4f}, .metallic = 0.4f, .roughness = 0.4f};
    params.toViewer = viewerAt(0.6f);
    const std::vector<vec3> directions = someDirections(100);
    const std::vector<EvaluatedDirection> plain = evaluate(params, directions);
    params.iridescence = 1.0f;
    params.iridescenceThickness = 0.0f;
    const std::vector<EvaluatedDirection> filmed = evaluate(params, directions);
    for (size_t i = 0; i < directions.size(); ++i) {
        EXPECT_NEAR(filmed[i].specular.r, plain[i].specular.r, 1e-4f * plain[i].specular.r + 1e-6f) << i;
        EXPECT_NEAR(filmed[i].diffuse.r, plain[i].diffuse.r, 1e-4f * plain[i].diffuse.r + 1e-6f) << i;
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
