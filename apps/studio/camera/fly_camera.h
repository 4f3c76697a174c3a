// A camera that a hand moves: around what it looks at, or through the scene.
#pragma once

#include "scene/model/scene.h"

namespace limpid::studio {

class FlyCamera {
  public:
    /// Looks from where `start` stands; turns around a point `distance` away. World units.
    FlyCamera(const scene::Camera& start, float distance);

    /// Around the target, which stays in the middle. Radians, to the right and upwards; never over the poles.
    void orbit(float right, float up);
    /// Turns where it stands; the target turns with it.
    void look(float right, float up);
    /// Turns to a point, which it turns around from then on.
    void focus(const vec3& point);
    /// Stands at `eye` and looks at `target`, with the horizon square to `up`. False, and nothing is done,
    /// where these are no camera: eye on target, or up along the view.
    bool place(const vec3& eye, const vec3& target, const vec3& up);
    /// Moves sideways with the target, in heights of the picture at the target's distance.
    void pan(float right, float up);
    /// Towards the target by a factor: 0.5 halves the distance.
    void zoom(float factor);
    /// Along its own axes, with the target. World units.
    void move(const vec3& rightUpForward);

    scene::Camera camera() const;
    const vec3& eye() const { return eye_; }
    vec3 target() const { return eye_ + distance_ * forward(); }
    vec3 forward() const;
    /// Of its horizon, a unit vector: the world's, but of cameras that started rolled their own.
    const vec3& up() const { return axes_[1]; }
    float distance() const { return distance_; }
    void setVerticalFov(float radians) { start_.verticalFov = radians; }
    /// Of what it sees without perspective, world units; 0: with perspective.
    void setHalfHeight(float halfHeight);

  private:
    vec3 right() const;
    void face(const vec3& direction);

    scene::Camera start_;
    vec3 eye_;
    mat3 axes_;          ///< columns: right, up and back where yaw and pitch are 0
    float yaw_, pitch_;  ///< radians: about up(), to the right; up from the horizon
    float distance_;
};

}  // namespace limpid::studio
