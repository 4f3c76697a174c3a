// Finds the cameras of a shot in its layers: the angle of view, the orientation and the movement.
#pragma once

#include <optional>
#include <span>

#include "base/math.h"
#include "image/image.h"

namespace limpid::shot {

/// A camera as it follows from world positions P of pixels and their depth z along its axis: with the axis f
/// and the eye e, z = f (P - e), and z x = r (P - e) / |r|^2 for the pixel's x in [-1, 1] and the camera's
/// `right` r, likewise y and `up`. All three are linear in their four unknowns, so they are found in least
/// squares, then again without the pixels that deviate (edges). The picture may be shifted. Returns
/// nothing if there are fewer than 100 pixels or all lie in one plane.
struct ViewFromPositions {
    vec3 eye, forward, right, up;  ///< as CameraParams has them
};
std::optional<ViewFromPositions> viewFromPositions(const image::Image& position, const image::Image& depth,
                                                   float farDepth);

/// Camera space below: x points right, y up, z towards the viewer.
///
/// Of points with the depth z along the axis and the distance d along the ray, which starts at the near plane
/// (depth n): d = (z - n) sqrt(1 + t^2 (x^2 + (r y)^2)), with x, y in [-1, 1]. r is the picture's height over
/// its width: height / (width * pixelAspect). `pixelAspect`: a pixel's width over its height. Returns the
/// tangent t of half the horizontal angle of view for which n varies least between the pixels (by the median
/// deviation); none if it varies by more than 0.2 % of the depth, or fewer than 1 % of the pixels are known.
std::optional<float> horizontalTangent(const image::Image& distance, const image::Image& depth,
                                       float farDepth, float pixelAspect = 1.0f);

/// Returns the rotation from camera space to the world that turns `camera` into `world` (three components,
/// where both are unit vectors). None if fewer than 100 pixels agree to 2 degrees, or all are parallel.
/// P. Besl and N. McKay, "A Method for Registration of 3-D Shapes", 1992, appendix: the largest eigenvector
/// of a 4x4 matrix is the rotation's quaternion.
std::optional<mat3> rotationBetween(const image::Image& camera, const image::Image& world);

/// A point of this frame in camera space, and where the previous frame showed it, on its picture plane
/// (x / -z, y / -z in that frame's camera space).
struct TrackedPoint {
    vec3 point;
    vec2 before;
};

/// previous position = rotation * position + translation, in the two cameras' spaces.
struct CameraMove {
    mat3 rotation{1.0f};
    vec3 translation{0.0f};
    float inliers = 0.0f;  ///< share of the points within `tolerance`
};

/// The movement that most points share, by Gauss-Newton steps with weights that fall for outliers (Geman and
/// McClure), from `rotation` on. `tolerance`: a quarter of a pixel on the picture plane. None if fewer than a
/// third of the points agree, or there are fewer than 50.
std::optional<CameraMove> cameraMove(std::span<const TrackedPoint> points, float tolerance,
                                     const mat3& rotation = mat3(1.0f));

}  // namespace limpid::shot
