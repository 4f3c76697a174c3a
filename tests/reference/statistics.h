// Statistical tests with p-values.
#pragma once

#include <string>
#include <vector>

namespace limpid::test {

/// P(X >= statistic) of the chi-square distribution: Press et al., "Numerical Recipes", section 6.2.
double chiSquareTail(double statistic, double degreesOfFreedom);

/// P(|Z| >= |z|) of the normal distribution.
double normalTail(double z);

struct ChiSquare {
    double statistic = 0.0;
    int degreesOfFreedom = 0;
    double p = 1.0;
    /// There are observations where none are expected.
    bool impossible = false;
    std::string worst;  ///< the bin that contributes most, for failure messages
};

/// Joins neighbouring bins until at least `least` observations are expected. Expectations must add up to the
/// number of observations (the caller includes a bin for those that fell nowhere).
ChiSquare chiSquare(const std::vector<double>& observed, const std::vector<double>& expected,
                    double least = 5.0);

}  // namespace limpid::test
