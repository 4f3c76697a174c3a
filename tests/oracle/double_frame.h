// A frame's inputs in double precision, as defined by the table at the start of docs/denoising.md. The
// denoisers' oracles read frames through it.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "denoise/api/host_frame.h"

namespace limpid::test {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

class DoubleFrame {
  public:
    /// The frame must outlive this object.
    explicit DoubleFrame(const denoise::HostFrame& frame) : frame_(frame) {}
    explicit DoubleFrame(denoise::HostFrame&&) = delete;

    dvec3 diffuse(size_t p) const;
    dvec3 specular(size_t p) const;
    dvec3 scattered(size_t p) const { return diffuse(p) + specular(p); }  ///< C
    dvec3 emission(size_t p) const;
    dvec3 albedo(size_t p) const;
    dvec3 albedoSpecular(size_t p) const;  ///< 0 if the frame has none
    bool hit(size_t p) const { return frame_.depth[4 * p + 1] > 0.0f; }
    double distance(size_t p) const;                        ///< z; 0 where the ray misses
    dvec3 normal(size_t p) const;                           ///< n; 0 where the ray misses
    dvec3 previousNormal(size_t p) const;                   ///< n'
    std::optional<dvec3> motion(size_t p) const;            ///< m; none if it is invalid
    std::optional<dvec3> reflectionMotion(size_t p) const;  ///< r; none if it is invalid
    double roughness(size_t p) const;                       ///< 1 if it is unknown
    double id(size_t p) const;                              ///< instance number + 1; 0 where the ray misses

    /// Returns (x, y) of the pixel's centre in [-1, 1]^2, y up.
    dvec2 screen(size_t p) const;
    /// Returns v = F + x R + y U.
    dvec3 ray(size_t p) const;

  private:
    const denoise::HostFrame& frame_;
};

/// Returns the divisor of light before it is resampled or filtered: max(a, min_albedo); 1 with a `minAlbedo`
/// of 0.
inline dvec3 modulation(const dvec3& albedo, double minAlbedo) {
    return minAlbedo > 0.0 ? glm::max(albedo, dvec3(minAlbedo)) : dvec3(1.0);
}

/// Checks with the range of the shaders: a sum that overflows in float32 is infinite there.
bool isFiniteInFloat(const dvec3& c);

}  // namespace limpid::test
