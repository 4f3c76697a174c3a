// Integrates functions over the sphere of directions by adaptive subdivision. The resulting cells also serve
// as bins for a chi-square test that are fine where the density is high.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/math.h"

namespace limpid::test {

/// Density per solid angle, and another function to integrate with it.
struct SphereValue {
    double pdf = 0.0, f = 0.0;
};

class SphereQuadrature {
  public:
    /// Evaluates the function in many directions at once, for a GPU.
    using Evaluate = std::function<std::vector<SphereValue>(const std::vector<vec3>&)>;

    /// Splits cells until their integrals are accurate to about `tolerance` and no cell has more than 1/256
    /// of the density.
    explicit SphereQuadrature(const Evaluate& evaluate, double tolerance = 2e-7);

    const SphereValue& integral() const { return integral_; }
    size_t binCount() const { return bins_.size(); }
    /// Returns the integral of the density over each bin.
    std::vector<double> binMasses() const;
    size_t binOf(const vec3& direction) const;
    size_t evaluations() const { return evaluations_; }

  private:
    /// theta and phi from `lower` to `lower` + `size`. Without children it is bin `bin`.
    struct Cell {
        double theta, phi, thetaSize, phiSize;
        SphereValue integral;
        size_t firstChild = 0, bin = 0;
    };

    void integrate(size_t first, const Evaluate& evaluate);
    std::array<Cell, 4> split(const Cell& cell) const;

    std::vector<Cell> cells_;
    std::vector<size_t> bins_;
    SphereValue integral_;
    size_t evaluations_ = 0;
};

}  // namespace limpid::test
