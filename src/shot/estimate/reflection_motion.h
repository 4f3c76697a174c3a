// The motion of what smooth mirrors show, in frames of other renderers.
#pragma once

#include <vector>

#include "denoise/api/host_frame.h"
#include "shot/frame/shot_frame.h"

namespace limpid::shot {

/// Where smooth mirrors show lamps and sky, that light has no noise but at its edges: makes it emission,
/// which is not filtered. `distance`: from the eye, 0 where nothing is seen.
void addMirroredEmission(const ShotLayers& layers, const Encoding& encoding,
                         const std::vector<float>& distance, denoise::HostFrame& frame);

/// Fills `reflectionMotion` where a smooth mirror is seen: a surface with hardly any diffuse light and less
/// refracted than reflected light, behind which `distance` goes on. Its image is where the mirror equation
/// says (as src/denoise/stages/ingest/ingest_reflection.comp), and stands still. `previous`: the camera of
/// the frame whose history is used. `frame` has the normals of the mirrors.
void addReflectionMotion(const ShotLayers& layers, const CameraParams& previous, denoise::HostFrame& frame);

/// Takes it away again where the mirror moves by itself. `frame` has its motion from `previous`.
void dropMovingMirrors(const CameraParams& previous, denoise::HostFrame& frame);

}  // namespace limpid::shot
