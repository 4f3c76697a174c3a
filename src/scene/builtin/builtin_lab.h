// Scenes for testing denoisers: each has one difficulty and is otherwise plain. Closed rooms, in metres, with
// fewer than 1,000 triangles (lab-glass: 10,000). Everything that moves does so in one clip of 4 s.
#pragma once

#include <array>

#include "scene/model/scene.h"

namespace limpid::scene {

/// The time in seconds at which the light of lab-light stops and that of lab-switch goes out.
inline constexpr float labChangeTime = 1.0f;

/// A diffuse room with blocks. Its only light, an instance "key", slides along the ceiling at constant speed
/// until labChangeTime, then stays.
Scene labLightScene();
/// The same room with two lights. From labChangeTime on, the warm one, an instance "key", is hidden behind
/// the ceiling.
Scene labSwitchScene();
/// A grille moves back and forth at 1.5 m/s in front of a textured wall and floor, so that parts of them are
/// disoccluded all the time.
Scene labDisocclusionScene();

/// Positions in lab-mirror, world space.
struct MirrorLab {
    std::array<vec3, 4> panelCorners;  ///< corners of the picture: top left, top right, bottom right, bottom
                                       ///< left
    vec3 mirrorPoint, mirrorNormal;    ///< the mirror's plane; the normal is unit, on the panel's side
    vec3 mirrorLower, mirrorUpper;     ///< corners of the mirror's rectangle

    /// Returns the mirror image of a point.
    vec3 reflected(const vec3& point) const;
};
const MirrorLab& mirrorLab();
/// The picture of testPictureTexture() on a desk in front of a standing, perfectly smooth mirror, on a floor
/// of roughness 0.15. For 4 s of the camera paths orbit and dolly, at aspect ratios from 16:9 on, the picture
/// and its reflection stay in view, similar in size, without overlapping. Nothing moves.
Scene labMirrorScene();

/// A room with wallpaper of bricks (with a normal map), checkers, plaster and wood, seen at grazing angles; a
/// dented ball and metal of varying roughness. Nothing moves.
Scene labTexturesScene();
/// A hall with 220 small coloured lights on its ceiling and walls, and diffuse and glossy blocks. Nothing
/// moves.
Scene labLightsScene();

/// On a table before a wall of checkers, a ball of glass and a bottle with a green liquid; beside it a window
/// pane before bricks. All are perfectly smooth. Nothing moves.
Scene labGlassScene();

}  // namespace limpid::scene
