// The shapes of synthetic_frames.h and the rays that see them; double precision, in units of the scene's
// scale.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "shaders/common/camera.h"

namespace limpid::test {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

/// A rigid transform: rotation about the y axis, then translation.
struct SyntheticPose {
    double angle = 0.0;
    dvec3 offset{0.0};

    dmat3 rotation() const;
    dvec3 toWorld(const dvec3& point) const { return rotation() * point + offset; }
    dvec3 toRest(const dvec3& point) const { return glm::transpose(rotation()) * (point - offset); }
};

/// Returns the pose of an instance in a frame.
SyntheticPose syntheticPose(uint32_t instance, int number, bool objectMoves);

/// A ray's hit: an instance and a point on it at rest, so that the point can be found in any frame.
struct SyntheticHit {
    double distance = std::numeric_limits<double>::infinity();
    uint32_t instance = UINT32_MAX;
    dvec3 point{0.0}, normal{0.0};  ///< at rest; the normal is outward, and the eye is never inside a body

    bool any() const { return instance != UINT32_MAX; }
};

struct SyntheticRay {
    dvec3 origin, direction;  ///< unit
};

SyntheticHit intersectSynthetic(const SyntheticRay& ray, int number, bool objectMoves);

/// Returns the camera of a frame as denoisers get it, with lengths times `scale`.
CameraParams syntheticCamera(int number, bool moves, bool orthographic, double scale, uint32_t width,
                             uint32_t height);

class SyntheticView {
  public:
    /// A point's projection: (x, y) in pixels and the distance from the eye.
    struct Projection {
        dvec2 pixel;
        double distance;
    };

    /// Uses the camera's float values exactly: their rounding is not an error of the frame.
    SyntheticView(const CameraParams& camera, double scale, uint32_t width, uint32_t height);

    SyntheticRay centreRay(uint32_t x, uint32_t y) const;
    /// Returns nothing if the point is behind the eye.
    std::optional<Projection> project(const dvec3& point) const;
    /// Projects the infinitely distant point in a direction, with distance 0. An orthographic camera never
    /// sees it.
    std::optional<Projection> projectDirection(const dvec3& direction) const;

  private:
    dvec2 toPixel(const dvec2& screen) const;

    dvec3 eye_;
    dmat3 axes_;  ///< right, up, forward
    bool orthographic_;
    dvec2 size_;
};

}  // namespace limpid::test
