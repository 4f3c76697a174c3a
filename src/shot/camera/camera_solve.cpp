#include "shot/camera/camera_solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <vector>

namespace limpid::shot {
namespace {

using glm::dmat3;
using glm::dvec3;

struct DepthSample {
    double area;  // x^2 + (r y)^2
    double distance, depth;
};

std::vector<DepthSample> depthSamples(const image::Image& distance, const image::Image& depth, float farDepth,
                                      float pixelAspect) {
    std::vector<DepthSample> samples;
    const double w = distance.width, h = distance.height;
    const double ratio = h / (w * static_cast<double>(pixelAspect));
    const uint32_t stride = std::max(1u, std::min(distance.width, distance.height) / 180u);
    for (uint32_t y = 0; y < distance.height; y += stride) {
        for (uint32_t x = 0; x < distance.width; x += stride) {
            const float d = distance.at(x, y, 0), z = depth.at(x, y, 0);
            if (!(z > 0.0f && z < farDepth && d > 0.0f && d < farDepth)) continue;
            const double sx = 2.0 * (x + 0.5) / w - 1.0, sy = (2.0 * (y + 0.5) / h - 1.0) * ratio;
            samples.push_back({sx * sx + sy * sy, static_cast<double>(d), static_cast<double>(z)});
        }
    }
    return samples;
}

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The median deviation of the near plane's depth from its median, relative to the depth.
double spreadOf(const std::vector<DepthSample>& samples, double tangent) {
    std::vector<double> near, deviation;
    for (const DepthSample& s : samples)
        near.push_back(s.depth - s.distance / std::sqrt(1.0 + tangent * tangent * s.area));
    std::vector<double> sorted = near;
    const double typical = median(sorted);
    for (size_t i = 0; i < near.size(); ++i)
        deviation.push_back(std::abs(near[i] - typical) / samples[i].depth);
    return median(deviation);
}

/// The largest eigenvector of a symmetric 4x4 matrix, by repeated squaring.
std::array<double, 4> largestEigenvector(std::array<std::array<double, 4>, 4> m) {
    double norm = 0.0;
    for (const auto& row : m)
        for (const double v : row) norm += std::abs(v);
    for (size_t i = 0; i < 4; ++i) m[i][i] += norm;  // makes all eigenvalues positive
    for (int step = 0; step < 30; ++step) {
        std::array<std::array<double, 4>, 4> square{};
        double largest = 0.0;
        for (size_t i = 0; i < 4; ++i)
            for (size_t j = 0; j < 4; ++j) {
                for (size_t k = 0; k < 4; ++k) square[i][j] += m[i][k] * m[k][j];
                largest = std::max(largest, std::abs(square[i][j]));
            }
        for (auto& row : square)
            for (double& v : row) v /= std::max(largest, 1e-300);
        m = square;
    }
    size_t column = 0;
    for (size_t i = 1; i < 4; ++i)
        if (m[i][i] > m[column][column]) column = i;
    std::array<double, 4> v{};
    double length = 0.0;
    for (size_t i = 0; i < 4; ++i) length += m[i][column] * m[i][column];
    for (size_t i = 0; i < 4; ++i) v[i] = m[i][column] / std::sqrt(std::max(length, 1e-300));
    return v;
}

/// Of pairs (a, b): the rotation that turns each a into b, in least squares.
dmat3 bestRotation(std::span<const std::pair<dvec3, dvec3>> pairs) {
    double s[3][3] = {};
    for (const auto& [a, b] : pairs)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) s[i][j] += a[i] * b[j];
    const auto q = largestEigenvector(
        {{{s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
          {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
          {s[2][0] - s[0][2], s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
          {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]}}});
    return glm::mat3_cast(glm::dquat(q[0], q[1], q[2], q[3]));
}

/// Solves the N x N system whose last column is the right side. False if it is singular.
template <size_t N>
bool solve(std::array<std::array<double, N + 1>, N>& m, std::array<double, N>& x) {
    for (size_t c = 0; c < N; ++c) {
        size_t pivot = c;
        for (size_t r = c + 1; r < N; ++r)
            if (std::abs(m[r][c]) > std::abs(m[pivot][c])) pivot = r;
        std::swap(m[c], m[pivot]);
        if (std::abs(m[c][c]) < 1e-15) return false;
        for (size_t r = 0; r < N; ++r) {
            if (r == c) continue;
            const double factor = m[r][c] / m[c][c];
            for (size_t k = c; k <= N; ++k) m[r][k] -= factor * m[c][k];
        }
    }
    for (size_t c = 0; c < N; ++c) x[c] = m[c][N] / m[c][c];
    return true;
}

/// A pixel's point, relative to a point near all, and what the three linear functions are there.
struct Located {
    dvec3 point;
    dvec3 values;  // z, z x, z y
};

/// The linear functions g P + c of the points, in least squares: a gradient and a constant each.
struct LinearViews {
    dvec3 gradient[3];
    double constant[3];
};
std::optional<LinearViews> fit(std::span<const Located> pixels) {
    LinearViews result{};
    for (int k = 0; k < 3; ++k) {
        std::array<std::array<double, 5>, 4> m{};
        for (const Located& pixel : pixels) {
            const double row[5] = {pixel.point.x, pixel.point.y, pixel.point.z, 1.0, pixel.values[k]};
            for (size_t i = 0; i < 4; ++i)
                for (size_t j = 0; j < 5; ++j)
                    m[i][j] += row[i] * row[j] / static_cast<double>(pixels.size());
        }
        std::array<double, 4> x{};
        if (!solve<4>(m, x)) return std::nullopt;
        result.gradient[k] = {x[0], x[1], x[2]};
        result.constant[k] = x[3];
    }
    return result;
}

double deviation(const LinearViews& views, const Located& pixel) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k)
        sum += std::abs(glm::dot(views.gradient[k], pixel.point) + views.constant[k] - pixel.values[k]);
    return sum / pixel.values[0];
}

std::vector<Located> locatedPixels(const image::Image& position, const image::Image& depth, float farDepth,
                                   dvec3& centre) {
    std::vector<Located> pixels;
    centre = dvec3(0.0);
    const double w = position.width, h = position.height;
    const uint32_t stride = std::max(1u, std::min(position.width, position.height) / 180u);
    for (uint32_t y = 0; y < position.height; y += stride) {
        for (uint32_t x = 0; x < position.width; x += stride) {
            const auto z = static_cast<double>(depth.at(x, y, 0));
            const dvec3 p(position.at(x, y, 0), position.at(x, y, 1), position.at(x, y, 2));
            if (!(z > 0.0 && z < static_cast<double>(farDepth)) || p == dvec3(0.0) ||
                !(glm::dot(p, p) < 1e30))
                continue;
            pixels.push_back({p, {z, z * (2.0 * (x + 0.5) / w - 1.0), z * (1.0 - 2.0 * (y + 0.5) / h)}});
            centre += p;
        }
    }
    centre /= static_cast<double>(std::max<size_t>(pixels.size(), 1));
    for (Located& pixel : pixels) pixel.point -= centre;
    return pixels;
}

struct Pose {
    dmat3 rotation;
    dvec3 translation;
};

/// The error on the picture plane, and its derivatives by a rotation vector and the translation.
struct Residual {
    double error[2];
    double derivative[2][6];
    bool visible;
};
Residual residualOf(const TrackedPoint& point, const Pose& pose, double unit) {
    const dvec3 turned = pose.rotation * dvec3(point.point);
    const dvec3 p = turned + pose.translation * unit;
    Residual r{};
    r.visible = p.z < 0.0;
    if (!r.visible) return r;
    for (int axis = 0; axis < 2; ++axis) {
        r.error[axis] = p[axis] / -p.z - static_cast<double>(point.before[axis]);
        dvec3 gradient(0.0);
        gradient[axis] = -1.0 / p.z;
        gradient.z = p[axis] / (p.z * p.z);
        const dvec3 byTurn = glm::cross(turned, gradient);
        for (int k = 0; k < 3; ++k) {
            r.derivative[axis][k] = byTurn[k];
            r.derivative[axis][3 + k] = gradient[k] * unit;
        }
    }
    return r;
}

/// One Gauss-Newton step with the scale of Geman and McClure's weights. False at the end.
bool step(std::span<const TrackedPoint> points, double scale, double unit, Pose& pose) {
    std::array<std::array<double, 7>, 6> system{};
    for (const TrackedPoint& point : points) {
        const Residual r = residualOf(point, pose, unit);
        if (!r.visible) continue;
        const double square = r.error[0] * r.error[0] + r.error[1] * r.error[1];
        const double share = scale * scale / (scale * scale + square), weight = share * share;
        for (int axis = 0; axis < 2; ++axis)
            for (size_t i = 0; i < 6; ++i) {
                for (size_t j = 0; j < 6; ++j)
                    system[i][j] += weight * r.derivative[axis][i] * r.derivative[axis][j];
                system[i][6] -= weight * r.derivative[axis][i] * r.error[axis];
            }
    }
    // Without this, a movement that the points do not determine would grow without limits.
    double trace = 0.0;
    for (size_t i = 0; i < 6; ++i) trace += system[i][i];
    for (size_t i = 0; i < 6; ++i) system[i][i] += 1e-9 * trace + 1e-12;
    std::array<double, 6> change{};
    if (!solve<6>(system, change)) return false;
    const dvec3 turn(change[0], change[1], change[2]);
    const double angle = glm::length(turn);
    if (angle > 0.0) pose.rotation = glm::mat3_cast(glm::angleAxis(angle, turn / angle)) * pose.rotation;
    pose.translation += dvec3(change[3], change[4], change[5]);
    return angle > 1e-9 || std::abs(change[3]) + std::abs(change[4]) + std::abs(change[5]) > 1e-9;
}

double shareWithin(std::span<const TrackedPoint> points, const Pose& pose, double unit, double tolerance) {
    const auto fits = std::count_if(points.begin(), points.end(), [&](const TrackedPoint& point) {
        const Residual r = residualOf(point, pose, unit);
        return r.visible && std::hypot(r.error[0], r.error[1]) < tolerance;
    });
    return static_cast<double>(fits) / static_cast<double>(points.size());
}

}  // namespace

std::optional<ViewFromPositions> viewFromPositions(const image::Image& position, const image::Image& depth,
                                                   float farDepth) {
    dvec3 centre;
    std::vector<Located> pixels = locatedPixels(position, depth, farDepth, centre);
    std::optional<LinearViews> views;
    for (int round = 0; round < 8; ++round) {
        if (pixels.size() < 100) return std::nullopt;
        views = fit(pixels);
        if (!views) return std::nullopt;
        std::vector<double> deviations;
        for (const Located& pixel : pixels) deviations.push_back(deviation(*views, pixel));
        const double limit = 2.5 * median(deviations) + 1e-6;
        std::erase_if(pixels, [&](const Located& pixel) { return deviation(*views, pixel) > limit; });
    }
    // The eye is where all three functions are 0.
    std::array<std::array<double, 4>, 3> m{};
    for (size_t k = 0; k < 3; ++k)
        m[k] = {views->gradient[k].x, views->gradient[k].y, views->gradient[k].z, -views->constant[k]};
    std::array<double, 3> eye{};
    const double axis = glm::length(views->gradient[0]);
    if (!solve<3>(m, eye) || std::abs(axis - 1.0) > 0.01) return std::nullopt;
    // A ray f + x r + y u has the depth 1 and the coordinates x and y: the inverse of the gradients.
    const dmat3 inverse =
        glm::inverse(glm::transpose(dmat3(views->gradient[0], views->gradient[1], views->gradient[2])));
    return ViewFromPositions{vec3(dvec3(eye[0], eye[1], eye[2]) + centre), vec3(inverse[0]), vec3(inverse[1]),
                             vec3(inverse[2])};
}

std::optional<float> horizontalTangent(const image::Image& distance, const image::Image& depth,
                                       float farDepth, float pixelAspect) {
    const std::vector<DepthSample> samples = depthSamples(distance, depth, farDepth, pixelAspect);
    if (samples.size() < 100) return std::nullopt;
    // Angles from 2 to 150 degrees: the best of a coarse grid, then of finer ones around it.
    double best = 1.0, span = 1.0;
    double least = spreadOf(samples, best);
    for (double degrees = 2.0; degrees < 150.0; degrees += 4.0) {
        const double tangent = std::tan(glm::radians(degrees) / 2.0), spread = spreadOf(samples, tangent);
        if (spread < least) {
            least = spread;
            best = tangent;
            span = 0.1 * (1.0 + tangent * tangent);
        }
    }
    for (int round = 0; round < 12; ++round, span *= 0.5) {
        for (const double tangent : {best - span, best - span / 2.0, best + span / 2.0, best + span}) {
            const double spread = tangent > 0.0 ? spreadOf(samples, tangent) : least;
            if (spread >= least) continue;
            least = spread;
            best = tangent;
        }
    }
    if (least > 0.002) return std::nullopt;
    return static_cast<float>(best);
}

std::optional<mat3> rotationBetween(const image::Image& camera, const image::Image& world) {
    std::vector<std::pair<dvec3, dvec3>> pairs, fitting;
    const size_t count = size_t{camera.width} * camera.height;
    for (size_t p = 0; p < count; ++p) {
        const dvec3 a(camera.pixels[3 * p], camera.pixels[3 * p + 1], camera.pixels[3 * p + 2]);
        const dvec3 b(world.pixels[3 * p], world.pixels[3 * p + 1], world.pixels[3 * p + 2]);
        const auto isUnit = [](const dvec3& v) { return std::abs(glm::dot(v, v) - 1.0) < 0.02; };
        if (isUnit(a) && isUnit(b)) pairs.emplace_back(a, b);
    }
    fitting = pairs;
    dmat3 rotation(1.0);
    for (int round = 0; round < 6; ++round) {
        if (fitting.size() < 100) return std::nullopt;
        rotation = bestRotation(fitting);
        // The first rounds are pulled by pixels in which the two normals are of different surfaces.
        const double cosine = std::cos(glm::radians(round < 2 ? 30.0 : 2.0));
        fitting.clear();
        for (const auto& pair : pairs)
            if (glm::dot(rotation * pair.first, pair.second) > cosine) fitting.push_back(pair);
    }
    if (fitting.size() < 100) return std::nullopt;
    dvec3 mean(0.0);
    for (const auto& [a, b] : fitting) mean += b / static_cast<double>(fitting.size());
    if (glm::length(mean) > 0.9999) return std::nullopt;  // parallel: any turn around them fits
    return mat3(rotation);
}

std::optional<CameraMove> cameraMove(std::span<const TrackedPoint> points, float tolerance,
                                     const mat3& rotation) {
    if (points.size() < 50) return std::nullopt;
    // The typical distance is the unit of the translation, so that all six unknowns have similar sizes.
    std::vector<double> distances;
    for (const TrackedPoint& point : points) distances.push_back(glm::length(dvec3(point.point)));
    const double unit = std::max(median(distances), 1e-30);
    Pose pose{dmat3(rotation), dvec3(0.0)};
    // Coarse to fine, so that a large movement is no outlier at first.
    for (double scale = 0.3;; scale = std::max(scale / 2.0, static_cast<double>(tolerance))) {
        for (int i = 0; i < 4 && step(points, scale, unit, pose); ++i) {
        }
        if (scale <= static_cast<double>(tolerance)) break;
    }
    CameraMove move;
    move.inliers = static_cast<float>(shareWithin(points, pose, unit, static_cast<double>(tolerance)));
    if (!(move.inliers > 1.0f / 3.0f)) return std::nullopt;
    move.rotation = mat3(pose.rotation);
    move.translation = vec3(pose.translation * unit);
    return move;
}

}  // namespace limpid::shot
