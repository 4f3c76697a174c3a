// Finds the nearest eye position from which all points are visible, and the size of the points in the
// picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math.h"
#include "scene/model/transform.h"

namespace limpid::scene {

/// Computes the nearest position from which a square picture shows all added points. Each of the picture's
/// four edges is a plane through the eye, and each point gives the plane a minimum distance.
class TightView {
  public:
    /// `view`: the camera's axes. Distances are measured from `center`; the points fill the fraction `part`
    /// of the picture's width and height.
    TightView(const mat4& view, const vec3& center, float fov, float part)
        : axes_(view), center_(center), slope_(double{part} * std::tan(0.5 * double{fov})) {}

    void add(const vec3& point) {
        const glm::dvec3 p = glm::transpose(axes_) * glm::dvec3(point - center_);
        edges_ = glm::max(edges_, glm::dvec4(p.x, -p.x, p.y, -p.y) + slope_ * p.z);
        nearest_ = std::max(nearest_, p.z);
    }

    /// Adds the points of another one with the same view.
    void join(const TightView& other) {
        edges_ = glm::max(edges_, other.edges_);
        nearest_ = std::max(nearest_, other.nearest_);
    }

    /// Stays at least `room` in front of the nearest point.
    vec3 eye(float room) const {
        const double distance = std::max({(edges_[0] + edges_[1]) / (2.0 * slope_),
                                          (edges_[2] + edges_[3]) / (2.0 * slope_), nearest_ + double{room}});
        const glm::dvec3 local(0.5 * (edges_[0] - edges_[1]), 0.5 * (edges_[2] - edges_[3]), distance);
        return center_ + vec3(axes_ * local);
    }

  private:
    glm::dmat3 axes_;
    vec3 center_;
    double slope_;
    glm::dvec4 edges_{std::numeric_limits<double>::lowest()};
    double nearest_ = std::numeric_limits<double>::lowest();
};

/// Measures the larger of width and height of the added points, in a square picture of side 1.
class PictureSize {
  public:
    PictureSize(const mat4& view, float fov) : toView_(glm::inverse(view)), slope_(std::tan(0.5f * fov)) {}

    void add(const vec3& point) {
        const vec3 p = transformPoint(toView_, point);
        const vec2 at = vec2(p) / (2.0f * slope_ * std::max(-p.z, 1e-20f));
        lower_ = glm::min(lower_, at);
        upper_ = glm::max(upper_, at);
    }
    /// Adds the points of another one with the same view.
    void join(const PictureSize& other) {
        lower_ = glm::min(lower_, other.lower_);
        upper_ = glm::max(upper_, other.upper_);
    }
    float largest() const { return std::max(upper_.x - lower_.x, upper_.y - lower_.y); }

  private:
    mat4 toView_;
    float slope_;
    vec2 lower_{std::numeric_limits<float>::max()}, upper_{std::numeric_limits<float>::lowest()};
};

}  // namespace limpid::scene
