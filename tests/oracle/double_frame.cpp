#include "tests/oracle/double_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid::test {
namespace {

dvec3 xyz(const std::vector<float>& layer, size_t p) {
    return {layer[4 * p], layer[4 * p + 1], layer[4 * p + 2]};
}

dvec3 normalisedOrZero(const dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : dvec3(0.0);
}

}  // namespace

dvec3 DoubleFrame::diffuse(size_t p) const {
    return xyz(frame_.diffuse, p);
}

dvec3 DoubleFrame::specular(size_t p) const {
    return xyz(frame_.specular, p);
}

dvec3 DoubleFrame::emission(size_t p) const {
    return xyz(frame_.emission, p);
}

dvec3 DoubleFrame::albedo(size_t p) const {
    return xyz(frame_.albedo, p);
}

dvec3 DoubleFrame::albedoSpecular(size_t p) const {
    return frame_.albedoSpecular.empty() ? dvec3(0.0) : xyz(frame_.albedoSpecular, p);
}

double DoubleFrame::distance(size_t p) const {
    return hit(p) ? double{frame_.depth[4 * p]} / double{frame_.depth[4 * p + 1]} : 0.0;
}

dvec3 DoubleFrame::normal(size_t p) const {
    return hit(p) ? normalisedOrZero(xyz(frame_.normal, p)) : dvec3(0.0);
}

dvec3 DoubleFrame::previousNormal(size_t p) const {
    return normalisedOrZero(xyz(frame_.previousNormal, p));
}

std::optional<dvec3> DoubleFrame::motion(size_t p) const {
    const float validShare = frame_.motion[4 * p + 3];
    if (validShare == 0.0f) return std::nullopt;
    return xyz(frame_.motion, p) / double{validShare};
}

std::optional<dvec3> DoubleFrame::reflectionMotion(size_t p) const {
    if (frame_.reflectionMotion.empty()) return std::nullopt;
    const float validShare = frame_.reflectionMotion[4 * p + 3];
    if (validShare == 0.0f || !std::isfinite(validShare)) return std::nullopt;
    const dvec3 r = xyz(frame_.reflectionMotion, p) / double{validShare};
    return isFiniteInFloat(r) ? std::optional(r) : std::nullopt;
}

double DoubleFrame::id(size_t p) const {
    const uint32_t instance = frame_.ids[2 * p];
    return instance == UINT32_MAX ? 0.0 : 1.0 + instance;
}

double DoubleFrame::roughness(size_t p) const {
    const double r = frame_.roughness.empty() ? 1.0 : double{frame_.roughness[4 * p]};
    return r >= 0.0 ? std::min(r, 1.0) : 1.0;
}

dvec2 DoubleFrame::screen(size_t p) const {
    const auto x = static_cast<double>(p % frame_.width), y = static_cast<double>(p / frame_.width);
    return {2.0 * (x + 0.5) / frame_.width - 1.0, 1.0 - 2.0 * (y + 0.5) / frame_.height};
}

dvec3 DoubleFrame::ray(size_t p) const {
    const dvec2 at = screen(p);
    const CameraParams& camera = frame_.camera;
    return dvec3(camera.forward) + at.x * dvec3(camera.right) + at.y * dvec3(camera.up);
}

bool isFiniteInFloat(const dvec3& c) {
    const dvec3 a = glm::abs(c);
    constexpr double largest = std::numeric_limits<float>::max();
    return a.x <= largest && a.y <= largest && a.z <= largest;
}

}  // namespace limpid::test
