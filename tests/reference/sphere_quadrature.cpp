#include "tests/reference/sphere_quadrature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limpid::test {
namespace {

constexpr size_t rootRows = 16, rootColumns = 32;
constexpr size_t maxCells = 60000;
constexpr double maxMass = 1.0 / 256.0;

// Gauss-Legendre quadrature with four points on [0, 1].
constexpr std::array<double, 4> nodes{0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
                                      0.9305681557970263};
constexpr std::array<double, 4> weights{0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                                        0.1739274225687269};

}  // namespace

SphereQuadrature::SphereQuadrature(const Evaluate& evaluate, double tolerance) {
    constexpr double pi64 = std::numbers::pi;
    for (size_t row = 0; row < rootRows; ++row) {
        for (size_t column = 0; column < rootColumns; ++column) {
            cells_.push_back({static_cast<double>(row) * pi64 / rootRows,
                              static_cast<double>(column) * 2.0 * pi64 / rootColumns,
                              pi64 / rootRows,
                              2.0 * pi64 / rootColumns,
                              {}});
        }
    }
    integrate(0, evaluate);
    std::vector<size_t> open(cells_.size());
    for (size_t i = 0; i < open.size(); ++i) open[i] = i;
    // Evaluates all open cells together: one GPU call per round.
    while (!open.empty()) {
        const size_t first = cells_.size();
        for (const size_t index : open) {
            cells_[index].firstChild = cells_.size();
            const std::array<Cell, 4> children = split(cells_[index]);
            cells_.insert(cells_.end(), children.begin(), children.end());
        }
        integrate(first, evaluate);
        std::vector<size_t> next;
        for (const size_t index : open) {
            const size_t child = cells_[index].firstChild;
            SphereValue sum;
            for (size_t i = child; i < child + 4; ++i) {
                sum.pdf += cells_[i].integral.pdf;
                sum.f += cells_[i].integral.f;
            }
            const SphereValue& whole = cells_[index].integral;
            const double error = std::max(std::abs(sum.pdf - whole.pdf), std::abs(sum.f - whole.f));
            const bool fine = error <= tolerance + 5e-4 * sum.pdf && sum.pdf < maxMass;
            if (!fine && cells_.size() < maxCells) {
                for (size_t i = child; i < child + 4; ++i) next.push_back(i);
            }
        }
        open = std::move(next);
    }
    for (size_t i = 0; i < cells_.size(); ++i) {
        if (cells_[i].firstChild != 0) continue;
        cells_[i].bin = bins_.size();
        bins_.push_back(i);
        integral_.pdf += cells_[i].integral.pdf;
        integral_.f += cells_[i].integral.f;
    }
}

std::array<SphereQuadrature::Cell, 4> SphereQuadrature::split(const Cell& cell) const {
    std::array<Cell, 4> children;
    for (size_t i = 0; i < 4; ++i) {
        const double theta = 0.5 * cell.thetaSize, phi = 0.5 * cell.phiSize;
        children[i] = {cell.theta + (i & 2 ? theta : 0.0), cell.phi + (i & 1 ? phi : 0.0), theta, phi, {}};
    }
    return children;
}

void SphereQuadrature::integrate(size_t first, const Evaluate& evaluate) {
    std::vector<vec3> directions;
    std::vector<double> factors;
    for (size_t c = first; c < cells_.size(); ++c) {
        const Cell& cell = cells_[c];
        for (size_t i = 0; i < 16; ++i) {
            const double theta = cell.theta + nodes[i / 4] * cell.thetaSize;
            const double phi = cell.phi + nodes[i % 4] * cell.phiSize;
            directions.emplace_back(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                    std::cos(theta));
            factors.push_back(weights[i / 4] * weights[i % 4] * cell.thetaSize * cell.phiSize *
                              std::sin(theta));
        }
    }
    const std::vector<SphereValue> values = evaluate(directions);
    evaluations_ += values.size();
    for (size_t i = 0; i < values.size(); ++i) {
        SphereValue& integral = cells_[first + i / 16].integral;
        integral.pdf += factors[i] * values[i].pdf;
        integral.f += factors[i] * values[i].f;
    }
}

std::vector<double> SphereQuadrature::binMasses() const {
    std::vector<double> masses;
    for (const size_t index : bins_) masses.push_back(cells_[index].integral.pdf);
    return masses;
}

size_t SphereQuadrature::binOf(const vec3& direction) const {
    constexpr double pi64 = std::numbers::pi;
    const double x = direction.x, y = direction.y, z = direction.z;
    const double theta = std::atan2(std::hypot(x, y), z);
    const double angle = std::atan2(y, x);
    const double phi = angle < 0.0 ? angle + 2.0 * pi64 : angle;
    const size_t row = std::min(static_cast<size_t>(theta / pi64 * rootRows), rootRows - 1);
    const size_t column = std::min(static_cast<size_t>(phi / (2.0 * pi64) * rootColumns), rootColumns - 1);
    const Cell* cell = &cells_[row * rootColumns + column];
    while (cell->firstChild != 0) {
        const size_t below = theta >= cell->theta + 0.5 * cell->thetaSize ? 2 : 0;
        const size_t right = phi >= cell->phi + 0.5 * cell->phiSize ? 1 : 0;
        cell = &cells_[cell->firstChild + below + right];
    }
    return cell->bin;
}

}  // namespace limpid::test
