// The shapes of synthetic_frames.h and how they are seen; double precision, in units of the scene's scale.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "shaders/common/camera.h"

namespace limpid::test {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

/// Rigid: turned about the y axis, then moved.
struct SyntheticPose {
    double angle = 0.0;
    dvec3 offset{0.0};

    dmat3 rotation() const;
    dvec3 toWorld(const dvec3& point) const { return rotation() * point + offset; }
    dvec3 toRest(const dvec3& point) const { return glm::transpose(rotation()) * (point - offset); }
};

/// Where every instance is in a frame.
SyntheticPose syntheticPose(uint32_t instance, int number, bool objectMoves);

/// What a ray meets: an instance and a point of it at rest, so that the point can be found in any frame.
struct SyntheticHit {
    double distance = std::numeric_limits<double>::infinity();
    uint32_t instance = UINT32_MAX;
    dvec3 point{0.0}, normal{0.0};  ///< at rest; the normal is outward, and no eye is ever within a body

    bool any() const { return instance != UINT32_MAX; }
};

struct SyntheticRay {
    dvec3 origin, direction;  ///< unit
};

SyntheticHit intersectSynthetic(const SyntheticRay& ray, int number, bool objectMoves);

/// The camera of a frame as denoisers get it, lengths times `scale`.
CameraParams syntheticCamera(int number, bool moves, bool orthographic, double scale, uint32_t width,
                             uint32_t height);

class SyntheticView {
  public:
    /// What sees a point: (x, y) in pixels and the distance from the eye.
    struct Projection {
        dvec2 pixel;
        double distance;
    };

    /// Of the camera's floats as they are: their rounding is no error of the frame.
    SyntheticView(const CameraParams& camera, double scale, uint32_t width, uint32_t height);

    SyntheticRay centreRay(uint32_t x, uint32_t y) const;
    /// Nothing where the point lies behind the eye.
    std::optional<Projection> project(const dvec3& point) const;
    /// Of the infinitely distant point in a direction, which an orthographic camera sees nowhere; distance 0.
    std::optional<Projection> projectDirection(const dvec3& direction) const;

  private:
    dvec2 toPixel(const dvec2& screen) const;

    dvec3 eye_;
    dmat3 axes_;  ///< right, up, forward
    bool orthographic_;
    dvec2 size_;
};

}  // namespace limpid::test
