#include "denoise/api/camera_matrices.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/text/format.h"

namespace limpid::denoise {
namespace {

struct Vector {
    double x = 0, y = 0, z = 0;
};
Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vector operator*(const Vector& a, double s) {
    return {a.x * s, a.y * s, a.z * s};
}
double dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
double length(const Vector& a) {
    return std::sqrt(dot(a, a));
}
vec3 toFloat(const Vector& a) {
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

Matrix toDouble(const float (&m)[16]) {
    Matrix result;
    std::ranges::copy(m, result.begin());
    return result;
}

Matrix multiply(const Matrix& a, const Matrix& b) {
    Matrix result{};
    for (size_t column = 0; column < 4; ++column)
        for (size_t row = 0; row < 4; ++row)
            for (size_t k = 0; k < 4; ++k) result[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    return result;
}

/// Throws UsageError.
[[noreturn]] void fail(const std::string& name, const char* fault) {
    throw UsageError(formatText("the matrix of the camera '{}' {}", name, fault));
}

/// Inverts by Gaussian elimination with row pivots. Throws UsageError with the matrix's name.
Matrix inverse(Matrix m, const std::string& name) {
    constexpr const char* fault = "is singular, or not finite";
    if (!std::ranges::all_of(m, [](double element) { return std::isfinite(element); })) fail(name, fault);
    Matrix result{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (size_t column = 0; column < 4; ++column) {
        size_t pivot = column;
        for (size_t row = column + 1; row < 4; ++row)
            if (std::abs(m[4 * column + row]) > std::abs(m[4 * column + pivot])) pivot = row;
        const double scale = m[4 * column + pivot];
        if (!(std::abs(scale) > 0.0) || !std::isfinite(scale)) fail(name, fault);
        for (size_t c = 0; c < 4; ++c) {
            std::swap(m[4 * c + column], m[4 * c + pivot]);
            std::swap(result[4 * c + column], result[4 * c + pivot]);
            m[4 * c + column] /= scale;
            result[4 * c + column] /= scale;
        }
        for (size_t row = 0; row < 4; ++row) {
            if (row == column) continue;
            const double factor = m[4 * column + row];
            for (size_t c = 0; c < 4; ++c) {
                m[4 * c + row] -= factor * m[4 * c + column];
                result[4 * c + row] -= factor * result[4 * c + column];
            }
        }
    }
    return result;
}

/// How far matrices may deviate from their ideal: much more than floats round, much less than is meant.
constexpr double tolerance = 1e-3;

/// Distances in view space count as distances in the world, so it must not be scaled or sheared.
void checkRigid(const Matrix& view, const std::string& name) {
    const Matrix expected{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, view[12], view[13], view[14], 1};
    bool rigid = true;
    for (size_t column = 0; column < 3; ++column) {
        for (size_t other = 0; other < 3; ++other) {
            double product = 0;
            for (size_t row = 0; row < 3; ++row) product += view[4 * column + row] * view[4 * other + row];
            rigid = rigid && std::abs(product - expected[4 * column + other]) <= tolerance;
        }
    }
    for (size_t column = 0; column < 4; ++column)
        rigid = rigid && std::abs(view[4 * column + 3] - expected[4 * column + 3]) <= tolerance;
    if (!rigid) fail(name, "is not rigid: it scales, or its axes are not perpendicular");
}

/// Depth and w must depend on the view-space z alone, and parallel rays run along the view axis. An
/// orthographic volume on both sides of the eye may be seen along either direction, since depth may be
/// reversed or not.
void checkProjection(const Matrix& p, const std::string& name) {
    const auto vanish = [](double a, double b, double scale) {
        return std::abs(a) + std::abs(b) <= tolerance * scale;
    };
    const bool orthographic = p[11] == 0.0;
    if (!vanish(p[2], p[6], std::abs(p[10]) + std::abs(p[14])) ||
        !vanish(p[3], p[7], std::abs(p[11]) + std::abs(p[15])) ||
        (orthographic && !vanish(p[8], p[9], std::abs(p[10]))))
        fail(name, "is oblique: planes of equal depth must be perpendicular to the view axis");
    if (!orthographic) return;
    const double first = -p[14] / p[10], last = (p[15] - p[14]) / p[10];  // z where depth is 0 and 1
    const double behind = std::min(std::abs(first), std::abs(last));
    if (first * last < 0.0 && behind > tolerance * std::abs(last - first))
        fail(name, "is orthographic and begins behind the eye: move the eye back instead");
}

Vector unproject(const Matrix& fromClip, double x, double y) {
    constexpr double z = 0.5;  // finite for infinite projections too
    const auto row = [&](size_t r) {
        return fromClip[r] * x + fromClip[4 + r] * y + fromClip[8 + r] * z + fromClip[12 + r];
    };
    const double w = row(3);
    return {row(0) / w, row(1) / w, row(2) / w};
}

/// All points of one clip depth lie in a plane perpendicular to the view axis, so rays through it are linear
/// in x and y.
CameraParams paramsOf(const Matrix& toWorld, const Matrix& fromClip, bool orthographic, double down,
                      double height) {
    const Vector eye{toWorld[12], toWorld[13], toWorld[14]};
    const Vector axis{toWorld[8], toWorld[9], toWorld[10]};
    const Vector centre = unproject(fromClip, 0, 0);
    const Vector toCentre = centre - eye;
    Vector right = unproject(fromClip, 1, 0) - centre;
    Vector up = unproject(fromClip, 0, -down) - centre;
    const double along = dot(toCentre, axis);
    CameraParams params{};
    params.orthographic = orthographic ? 1u : 0u;
    if (orthographic) {
        const Vector forward = axis * ((along < 0.0 ? -1.0 : 1.0) / length(axis));
        params.origin = toFloat(centre - forward * dot(toCentre, forward));
        params.forward = toFloat(forward);
    } else {
        const double depth = std::abs(along) / length(axis);
        params.origin = toFloat(eye);
        params.forward = toFloat(toCentre * (1.0 / depth));
        right = right * (1.0 / depth);
        up = up * (1.0 / depth);
    }
    params.right = toFloat(right);
    params.up = toFloat(up);
    params.spread = static_cast<float>(2.0 * length(up) / height);
    return params;
}

vec4 rowOf(const Matrix& m, size_t row, double sign = 1.0) {
    const auto at = [&](size_t column) { return static_cast<float>(sign * m[4 * column + row]); };
    return {at(0), at(1), at(2), at(3)};
}

}  // namespace

CameraMatrices cameraFromMatrices(const float (&view)[16], const float (&projection)[16], bool yUp,
                                  uint32_t height, const char* prefix) {
    const Matrix v = toDouble(view), p = toDouble(projection), toClip = multiply(p, v);
    const std::string viewName = std::string(prefix) + "view";
    const std::string projectionName = std::string(prefix) + "projection";
    const Matrix toWorld = inverse(v, viewName);
    checkRigid(v, viewName);
    const Matrix fromClip = inverse(toClip, projectionName);
    checkProjection(p, projectionName);
    const double down = yUp ? -1.0 : 1.0;  // clip-space y of the lower edge
    const bool orthographic = p[11] == 0.0;
    CameraMatrices result;
    result.params = paramsOf(toWorld, fromClip, orthographic, down, height);
    result.clip = {rowOf(toClip, 0), rowOf(toClip, 1, down), rowOf(toClip, 3)};
    // The rows of a rotation are the axes of its target space.
    for (size_t axis = 0; axis < 3; ++axis)
        result.axes[axis] = {static_cast<float>(v[axis]), static_cast<float>(v[4 + axis]),
                             static_cast<float>(v[8 + axis])};
    result.deviceDepth = {static_cast<float>(p[10]), static_cast<float>(p[14]), static_cast<float>(p[11]),
                          static_cast<float>(p[15])};
    // The sign of the view-space z of the middle of the clip volume: the view direction.
    const double into = (0.5 * p[15] - p[14]) / (p[10] - 0.5 * p[11]) < 0.0 ? -1.0 : 1.0;
    const auto depthAt = [&](double z) { return (p[10] * z + p[14]) / (p[11] * z + p[15]); };
    result.reversed = depthAt(2.0 * into) < depthAt(into);
    return result;
}

}  // namespace limpid::denoise
