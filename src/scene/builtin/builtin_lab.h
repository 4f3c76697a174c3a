// Scenes for trying denoisers: each has one thing that is hard for them and is otherwise plain. Closed rooms,
// below 1,000 triangles, metres. What moves, moves in one clip of 4 s.
#pragma once

#include <array>

#include "scene/model/scene.h"

namespace limpid::scene {

/// When the light of lab-light arrives and that of lab-switch goes out, seconds.
inline constexpr float labChangeTime = 1.0f;

/// A diffuse room with blocks. Its only light, an instance "key", slides along the ceiling at constant speed
/// until labChangeTime, then stays.
Scene labLightScene();
/// The same room with two lights. The warm one, an instance "key", is behind the ceiling from labChangeTime
/// on.
Scene labSwitchScene();
/// A grille goes to and fro at 1.5 m/s before a textured wall and floor; it covers and bares them all the
/// time.
Scene labDisocclusionScene();

/// Where things are in lab-mirror, world space.
struct MirrorLab {
    std::array<vec3, 4> panelCorners;  ///< of the picture: top left, top right, bottom right, bottom left
    vec3 mirrorPoint, mirrorNormal;    ///< the reflecting plane; the normal is unit, on the panel's side
    vec3 mirrorLower, mirrorUpper;     ///< the rectangle of it that reflects

    /// Where a point is seen in the mirror.
    vec3 reflected(const vec3& point) const;
};
const MirrorLab& mirrorLab();
/// The picture of testPictureTexture() on a desk before a standing, perfectly smooth mirror, on a floor of
/// roughness 0.15. For 4 s of the camera paths orbit and dolly, from 16:9 on, the picture and its reflection
/// stay in view, about as large as each other, and apart. Still.
Scene labMirrorScene();

/// A room papered with bricks (with a normal map), checker, plaster and wood, seen along the walls; a dented
/// ball and metal of uneven gloss. Still.
Scene labTexturesScene();
/// A hall with 220 small coloured lights on its ceiling and walls, and diffuse and glossy blocks. Still.
Scene labLightsScene();

}  // namespace limpid::scene
