#include "tests/oracle/double_atrous.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace limpid::test {
namespace {

/// Limits a value to what a half can store. NaN becomes 0; it can only come from the frame's own light.
double storable(double value) {
    constexpr double largestHalf = 65504.0;
    return std::isnan(value) ? 0.0 : std::clamp(value, -largestHalf, largestHalf);
}

class Level {
  public:
    Level(const denoise::HostFrame& frame, const std::vector<dvec4>& light, const AtrousGeometry& geometry,
          uint32_t i, const DoubleAtrousParams& params)
        : width_(frame.width),
          height_(frame.height),
          light_(light),
          geometry_(geometry),
          step_(int64_t{1} << i),
          params_(params) {
        if (!params.plane) return;
        const DoubleFrame pixels(frame);
        const CameraParams& camera = frame.camera;
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            const double d = geometry.distance[p];
            const dvec2 at = pixels.screen(p);
            const bool orthographic = camera.orthographic != 0;
            points_.push_back(orthographic ? at.x * dvec3(camera.right) + at.y * dvec3(camera.up) +
                                                 d * dvec3(camera.forward)
                                           : d * pixels.ray(p));
            eyeDistances_.push_back(orthographic ? d : glm::length(points_.back()));
        }
    }

    dvec4 at(int64_t x, int64_t y) const {
        constexpr std::array<double, 5> spline{1.0 / 16, 4.0 / 16, 6.0 / 16, 4.0 / 16, 1.0 / 16};
        const size_t p = index(x, y);
        if (!sees(p)) return light_[p];
        dvec3 sum(0.0);
        double weights = 0.0;
        for (size_t k = 0; k < 5; ++k) {
            for (size_t j = 0; j < 5; ++j) {
                const int64_t qx = x + step_ * (static_cast<int64_t>(j) - 2);
                const int64_t qy = y + step_ * (static_cast<int64_t>(k) - 2);
                if (qx < 0 || qy < 0 || qx >= width_ || qy >= height_ || !sees(index(qx, qy))) continue;
                const size_t q = index(qx, qy);
                const double weight = spline[j] * spline[k] * (q == p ? centreFactor(p) : edgeWeight(p, q));
                sum += weight * dvec3(light_[q]);
                weights += weight;
            }
        }
        return {sum / weights, light_[p].w};
    }

  private:
    size_t index(int64_t x, int64_t y) const { return static_cast<size_t>(y * width_ + x); }
    bool sees(size_t p) const { return geometry_.distance[p] > 0.0; }

    double centreFactor(size_t p) const {
        if (params_.sampleTarget == 0.0) return 1.0;
        return 1.0 + light_[p].w * static_cast<double>(step_ * step_) / params_.sampleTarget;
    }

    double edgeWeight(size_t p, size_t q) const {
        const auto& normal = geometry_.normal;
        const dvec3 turn = normal[p] - normal[q];
        const double apart = params_.plane ? glm::dot(normal[p], points_[q] - points_[p]) / eyeDistances_[p]
                                           : geometry_.distance[p] - geometry_.distance[q];
        const auto step = static_cast<double>(step_);
        double weight = std::exp(-glm::dot(turn, turn) / (step * step * params_.normalFactor)) *
                        std::exp(-apart * apart / params_.depthFactor);
        if (params_.colorFactor > 0.0) {
            const dvec3 change = dvec3(light_[p]) - dvec3(light_[q]);
            weight *= std::exp(-glm::dot(change, change) * step * step / params_.colorFactor);
        }
        return weight;
    }

    int64_t width_, height_;
    const std::vector<dvec4>& light_;
    const AtrousGeometry& geometry_;
    int64_t step_;
    const DoubleAtrousParams& params_;
    std::vector<dvec3> points_;         ///< X, relative to the eye
    std::vector<double> eyeDistances_;  ///< z
};

}  // namespace

std::vector<dvec4> scatteredLight(const denoise::HostFrame& frame) {
    const DoubleFrame pixels(frame);
    std::vector<dvec4> light;
    for (size_t p = 0; p < frame.pixelCount(); ++p) light.emplace_back(pixels.scattered(p), 1.0);
    return light;
}

Demodulated demodulate(const denoise::HostFrame& frame, const std::vector<dvec4>& mean,
                       const DoubleAtrousParams& params) {
    const DoubleFrame pixels(frame);
    const bool alongForward = params.plane && frame.camera.orthographic == 0;
    Demodulated out;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const double z = pixels.distance(p);
        const dvec3 divisor = z > 0.0 ? modulation(pixels.albedo(p), params.minAlbedo) : dvec3(1.0);
        const dvec3 light = dvec3(mean[p]) / divisor;
        out.light.emplace_back(storable(light.x), storable(light.y), storable(light.z),
                               z > 0.0 ? mean[p].w : -1.0);
        out.geometry.normal.push_back(pixels.normal(p));
        out.geometry.distance.push_back(alongForward ? z / glm::length(pixels.ray(p)) : z);
    }
    return out;
}

std::vector<dvec4> level(const denoise::HostFrame& frame, const std::vector<dvec4>& light,
                         const AtrousGeometry& geometry, uint32_t i, const DoubleAtrousParams& params) {
    const Level filter(frame, light, geometry, i, params);
    std::vector<dvec4> filtered;
    for (uint32_t y = 0; y < frame.height; ++y) {
        for (uint32_t x = 0; x < frame.width; ++x) filtered.push_back(filter.at(x, y));
    }
    return filtered;
}

std::vector<dvec4> modulate(const denoise::HostFrame& frame, const std::vector<dvec4>& light,
                            const DoubleAtrousParams& params) {
    const DoubleFrame pixels(frame);
    std::vector<dvec4> result;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const dvec3 albedo = modulation(pixels.albedo(p), params.minAlbedo);
        const dvec3 scattered = pixels.hit(p) ? dvec3(light[p]) * albedo : pixels.scattered(p);
        result.emplace_back(scattered + pixels.emission(p), 1.0);
    }
    return result;
}

std::vector<dvec4> filterAtrous(const denoise::HostFrame& frame, const std::vector<dvec4>& mean,
                                const DoubleAtrousParams& params) {
    Demodulated d = demodulate(frame, mean, params);
    for (uint32_t i = 0; i < params.levels; ++i) d.light = level(frame, d.light, d.geometry, i, params);
    return modulate(frame, d.light, params);
}

dvec3 decodeOctahedral(uint32_t packed, int bits) {
    const int64_t largest = (int64_t{1} << (bits - 1)) - 1;
    const auto snorm = [&](uint32_t word) {
        const int64_t low = word & ((int64_t{1} << bits) - 1),
                      value = low > largest ? low - (int64_t{1} << bits) : low;
        return std::max(static_cast<double>(value) / static_cast<double>(largest), -1.0);
    };
    const dvec2 e(snorm(packed), snorm(packed >> bits));
    dvec3 n(e, 1.0 - std::abs(e.x) - std::abs(e.y));
    // The lower half of the octahedron is folded over the edges of the upper one.
    const double fold = std::max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    return glm::normalize(n);
}

AtrousGeometry decodeGeometry(const std::vector<uint32_t>& words) {
    AtrousGeometry geometry;
    for (size_t i = 0; i + 1 < words.size(); i += 2) {
        geometry.normal.push_back(decodeOctahedral(words[i]));
        geometry.distance.push_back(double{std::bit_cast<float>(words[i + 1])});
    }
    return geometry;
}

}  // namespace limpid::test
