// Compares values of the BSDF with the published formulas, in double precision:
// B. Walter et al., "Microfacet models for refraction through rough surfaces", EGSR 2007; E. Heitz,
// "Understanding the masking-shadowing function in microfacet-based BRDFs", JCGT 2014; C. Kulla, A. Conty,
// SIGGRAPH 2017 course.
#include <cmath>

#include "tests/gpu/bsdf/bsdf_fixture.h"
#include "tests/reference/bsdf_reference.h"

namespace limpid::test {
namespace {

/// Returns the exact Fresnel reflectance from angles.
double fresnel(double cosine, double eta) {
    const double sine = std::sqrt(1.0 - cosine * cosine) / eta;
    if (sine >= 1.0) return 1.0;
    const double a = std::acos(cosine), b = std::asin(sine);
    if (a < 1e-6) return std::pow((eta - 1.0) / (eta + 1.0), 2.0);
    const double s = std::sin(a - b) / std::sin(a + b), p = std::tan(a - b) / std::tan(a + b);
    return 0.5 * (s * s + p * p);
}

/// f cos of refraction (Walter, equation 21) with height-correlated masking (Heitz 2014, equation 99), times
/// eta^2: the energy form described in bsdf.glsl. The light comes from behind the surface, where the index is
/// eta times that of the viewer's side.
double refracted(const dvec3& wo, const dvec3& wi, double alpha, double eta) {
    dvec3 h = -(wo + eta * wi);
    if (h.z < 0.0) h = -h;
    const double length = glm::length(h);
    h /= length;
    const double oh = glm::dot(wo, h), ih = glm::dot(wi, h);
    if (oh <= 0.0 || ih >= 0.0) return 0.0;
    const double g = std::beta(1.0 + lambda(wo, alpha), 1.0 + lambda(wi, alpha));
    const double f = std::abs(oh * ih) / (std::abs(wo.z) * std::abs(wi.z)) * (1.0 - fresnel(oh, eta)) * g *
                     distribution(h, alpha) / std::pow(oh + eta * ih, 2.0);
    return f * eta * eta * std::abs(wi.z);
}

/// Returns one of the two texels of the table of dielectrics, interpolated linearly in its three dimensions;
/// one half is for eta below 1, the other for eta from 1 on.
glm::dvec4 dielectricTable(const std::vector<vec4>& table, double cosine, double roughness, double eta,
                           int texel) {
    const int size = static_cast<int>(layout::DIELECTRIC_TABLE_SIZE),
              nodes = static_cast<int>(layout::DIELECTRIC_ETA_NODES);
    const double scale = double{layout::DIELECTRIC_ETA_SCALE};
    const double first = std::log(1.0 + double{layout::SMOOTH_IOR_DIFFERENCE});
    const double coordinate = std::log(1.0 + (std::abs(std::log(eta)) - first) / scale) /
                              std::log(1.0 + (std::log(double{layout::DIELECTRIC_ETA_MAX}) - first) / scale);
    const double below = std::min(eta, 1.0 / eta), critical = std::sqrt(1.0 - below * below);
    const double p[3] = {cosine * (1.0 + critical) / (cosine + critical) * (size - 1), roughness * (size - 1),
                         coordinate * (nodes - 1)};
    const int lengths[3] = {size, size, nodes};
    glm::dvec4 sum(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1.0;
        int index = 0, stride = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const int low = std::min(static_cast<int>(p[axis]), lengths[axis] - 2), up = corner >> axis & 1;
            weight *= up ? p[axis] - low : 1.0 - (p[axis] - low);
            index += (low + up) * stride;
            stride *= lengths[axis];
        }
        sum +=
            weight * glm::dvec4(table[static_cast<size_t>((index + (eta < 1.0 ? 0 : stride)) * 2 + texel)]);
    }
    return sum;
}

/// Returns the tint of white light after several facets of a metal (bsdf.glsl, multipleTint).
double tint(double f0, double roughness, double out, double in) {
    const double x = std::min(1.0 - roughness, 0.5);
    const double e = std::min(0.48 + 0.89 * x - 0.66 * x * x + (0.2 - 0.095 * x) * (2.0 - out - in), 1.0);
    const double grazing = std::pow(1.0 - out, 2.0) + std::pow(1.0 - in, 2.0);
    const double f = f0 + (1.0 - f0) * (0.014 + 0.08 * x + (0.069 - 0.105 * x + 1.125 * x * x) * grazing);
    return f * f * e / (1.0 - f * (1.0 - e));
}

class BsdfFormulaTest : public BsdfTest {
  protected:
    using Formula = std::function<dvec3(const BsdfParams&, const dvec3& wo, const dvec3& wi)>;

    static std::vector<vec3> someDirections() {
        std::vector<vec3> directions;
        for (int i = 0; i < 2000; ++i) {
            const double z = 1.0 - 2.0 * (i + 0.5) / 2000, phi = i * 2.399963229728653,
                         r = std::sqrt(1.0 - z * z);
            if (std::abs(z) > 0.01) directions.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
        }
        return directions;
    }

    /// Close to total reflection, 1 - F is a difference of nearly equal numbers, which has fewer digits in
    /// float32.
    static double tolerance(const BsdfParams& p, const dvec3& wo, const dvec3& wi) {
        if (p.transmission == 0.0f || wi.z > 0.0) return 1e-4;
        const double eta = p.front ? double{p.ior} : 1.0 / double{p.ior};
        const dvec3 h = glm::normalize(wo + eta * wi);
        return fresnel(std::abs(glm::dot(wo, h)), eta) > 0.8 ? 2e-3 : 1e-4;
    }

    /// `specular`: compares the specular part, otherwise the diffuse one.
    void compare(NamedMaterial material, bool specular, const Formula& formula) {
        const std::vector<vec3> directions = someDirections();
        double worst = 0.0;
        for (const float cosine : {0.95f, 0.5f, 0.15f}) {
            material.params.toViewer = viewerAt(cosine);
            const std::vector<EvaluatedDirection> values = evaluate(material.params, directions);
            for (size_t i = 0; i < directions.size(); ++i) {
                const dvec3 wo(material.params.toViewer), wi(directions[i]);
                const dvec3 expected = formula(material.params, wo, wi);
                const dvec3 found(specular ? values[i].specular : values[i].diffuse);
                for (int k = 0; k < 3; ++k) {
                    const double error = std::abs(found[k] - expected[k]) / (std::abs(expected[k]) + 1e-4);
                    worst = std::max(worst, error);
                    ASSERT_LT(error, tolerance(material.params, wo, wi))
                        << describe(material) << "\n  wi " << wi.x << ' ' << wi.y << ' ' << wi.z
                        << " channel " << k << ": " << found[k] << ", by the formula " << expected[k];
                }
            }
        }
        fmt::print("{}: within {:.2g} of the formula\n", describe(material), worst);
    }
};

TEST_F(BsdfFormulaTest, Lambert) {
    compare({"Lambertian", {.baseColor = {0.8f, 0.4f, 0.1f}, .specular = 0.0f}}, false,
            [](const BsdfParams& p, const dvec3&, const dvec3& wi) {
                return dvec3(p.baseColor) * (std::max(wi.z, 0.0) / pi64);
            });
}

TEST_F(BsdfFormulaTest, MetalWithMultipleScattering) {
    for (const float roughness : {0.2f, 0.5f, 1.0f}) {
        const BsdfParams params{.baseColor = {0.95f, 0.6f, 0.2f}, .metallic = 1.0f, .roughness = roughness};
        compare({"metal", params}, true, [&](const BsdfParams& p, const dvec3& wo, const dvec3& wi) {
            dvec3 value(0.0);
            if (wi.z <= 0.0) return value;
            const glm::dvec4 out = ggxTable(data().ggxTable, wo.z, roughness),
                             in = ggxTable(data().ggxTable, wi.z, roughness),
                             averages = ggxAverages(data().ggxTable, roughness);
            const double missing = (1.0 - out.x - out.y) * (1.0 - in.x - in.y);
            const double spread =
                averages.z * missing / (pi64 * (1.0 - averages.x - averages.y)) + out.w * in.w;
            const double alpha = double{roughness} * double{roughness};
            const double schlickTerm = schlick(0.0, 1.0, glm::dot(wo, glm::normalize(wo + wi)));
            for (int k = 0; k < 3; ++k) {
                const double f0 = double{p.baseColor[k]}, f = f0 + (1.0 - f0) * schlickTerm;
                value[k] = reflected(wo, wi, alpha, f0, 1.0) * (1.0 + f * out.z * in.z) +
                           tint(f0, double{roughness}, wo.z, wi.z) * std::max(spread, 0.0) * wi.z;
            }
            return value;
        });
    }
}

/// A coat over a diffuse base that gets what the coat's strongest channel transmits, in and out.
TEST_F(BsdfFormulaTest, PlasticWithSpecularColour) {
    const BsdfParams params{.baseColor = {0.8f, 0.4f, 0.1f},
                            .roughness = 0.4f,
                            .specular = 0.8f,
                            .specularColor = {0.9f, 0.5f, 0.3f}};
    const auto coat = [](const BsdfParams& p) {
        const double f0 = std::pow((double{p.ior} - 1.0) / (double{p.ior} + 1.0), 2.0);
        return dvec3(p.specularColor) * (f0 * double{p.specular});
    };
    compare({"plastic, coat", params}, true, [&](const BsdfParams& p, const dvec3& wo, const dvec3& wi) {
        dvec3 value(0.0);
        if (wi.z <= 0.0) return value;
        const double alpha = double{p.roughness} * double{p.roughness};
        for (int k = 0; k < 3; ++k) value[k] = reflected(wo, wi, alpha, coat(p)[k], double{p.specular});
        return value;
    });
    compare({"plastic, base", params}, false, [&](const BsdfParams& p, const dvec3& wo, const dvec3& wi) {
        if (wi.z <= 0.0) return dvec3(0.0);
        const double f0 = coat(p).r, f90 = double{p.specular};
        const glm::dvec4 out = ggxTable(data().ggxTable, wo.z, double{p.roughness});
        const glm::dvec4 in = ggxTable(data().ggxTable, wi.z, double{p.roughness});
        const double through = (1.0 - f0 * out.x - f90 * out.y) * (1.0 - f0 * in.x - f90 * in.y);
        const glm::dvec4 averages = ggxAverages(data().ggxTable, double{p.roughness});
        return dvec3(p.baseColor) * (through / (1.0 - f0 * averages.x - f90 * averages.y) / pi64 * wi.z);
    });
}

TEST_F(BsdfFormulaTest, RefractingBoundary) {
    for (const bool front : {true, false}) {
        for (const float roughness : {0.3f, 0.7f}) {
            const BsdfParams params{.baseColor = {0.9f, 0.5f, 0.2f},
                                    .roughness = roughness,
                                    .ior = 1.5f,
                                    .transmission = 1.0f,
                                    .thin = 0,
                                    .front = front};
            compare({"glass", params}, true, [&](const BsdfParams& p, const dvec3& wo, const dvec3& wi) {
                const double alpha = double{roughness} * double{roughness};
                const double eta = front ? double{p.ior} : 1.0 / double{p.ior};
                const bool above = wi.z > 0.0;
                const auto entry = [&](double cosine, double index, int texel) {
                    return dielectricTable(data().dielectricTable, cosine, double{roughness}, index, texel);
                };
                const glm::dvec4 out = entry(wo.z, eta, 0);
                const glm::dvec4 in = entry(std::abs(wi.z), above ? eta : 1.0 / eta, 1);
                const double cosine = std::abs(wi.z) / pi64,
                             unmasked = 1.0 / ((1.0 + lambda(wo, alpha)) *
                                               std::beta(1.0 + lambda(wo, alpha), 1.0 + lambda(wi, alpha)));
                if (!above) {
                    return dvec3(p.baseColor) * (refracted(wo, wi, alpha, eta) * (1.0 + out.y * unmasked) +
                                                 out.w * in.y / in.w * cosine);
                }
                const dvec3 m = glm::normalize(wo + wi);
                const double visible = distribution(m, alpha) / (4.0 * wo.z * (1.0 + lambda(wo, alpha)));
                const double masking =
                    (1.0 + lambda(wo, alpha)) / (1.0 + lambda(wo, alpha) + lambda(wi, alpha));
                return dvec3(fresnel(glm::dot(wo, m), eta) * visible * (masking + out.x) +
                             out.z * in.x / in.z * cosine);
            });
        }
    }
}

/// Compares the table used by the coat and the metal with quadrature of the formula.
TEST_F(BsdfFormulaTest, AlbedoTable) {
    double worst = 0.0;
    for (const double roughness : {0.2, 0.45, 0.8, 1.0}) {
        for (const double cosine : {0.1, 0.35, 0.7, 0.98}) {
            const dvec3 wo(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
            dvec3 sum(0.0);
            constexpr int rows = 600, columns = 600;
            for (int i = 0; i < rows; ++i) {
                for (int j = 0; j < columns; ++j) {
                    const double theta = (i + 0.5) / rows * pi64 / 2.0, phi = (j + 0.5) / columns * pi64;
                    const dvec3 wi(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                   std::cos(theta));
                    const double area = std::sin(theta) * (pi64 / 2.0 / rows) * (2.0 * pi64 / columns);
                    sum.x += area * reflected(wo, wi, roughness * roughness, 1.0, 0.0);
                    sum.y += area * reflected(wo, wi, roughness * roughness, 0.0, 1.0);
                }
            }
            const glm::dvec4 found = ggxTable(data().ggxTable, cosine, roughness);
            worst = std::max({worst, std::abs(found.x - sum.x), std::abs(found.y - sum.y)});
            EXPECT_NEAR(found.x, sum.x, 5e-3) << "roughness " << roughness << " cosine " << cosine;
            EXPECT_NEAR(found.y, sum.y, 5e-3) << "roughness " << roughness << " cosine " << cosine;
        }
    }
    fmt::print("albedo table: within {:.2g} of quadrature\n", worst);
}

}  // namespace
}  // namespace limpid::test
