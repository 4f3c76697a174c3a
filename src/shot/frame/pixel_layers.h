// Pixel by pixel, what denoisers read of a file's layers. Private to src/shot: users include shot_frame.h.
#pragma once

#include <optional>
#include <vector>

#include "base/for_each_index.h"
#include "denoise/api/host_frame.h"
#include "shot/frame/shot_frame.h"

namespace limpid::shot {

inline constexpr float largestHalf = 65504.0f;

/// Calls action(p) for each of `count` pixels, on all cores.
template <typename Action>
void forEachPixel(size_t count, Action action) {
    forEachIndex(count, action);
}

/// Of Rec. 709 primaries.
inline float luminance(const vec3& c) {
    return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

/// Along the ray; 0 where nothing is seen.
inline float distanceOf(const denoise::HostFrame& frame, size_t p) {
    const float share = frame.depth[4 * p + 1];
    return share > 0.0f ? frame.depth[4 * p] / share : 0.0f;
}

/// A pixel's centre in [-1, 1]^2, y up.
vec2 onScreen(size_t p, const ShotLayers& layers);
/// Through that point; its component along the camera's axis is 1.
vec3 rayOf(const CameraParams& camera, const vec2& at);
vec3 startOf(const CameraParams& camera, const vec2& at);
/// Columns: right, up, towards the viewer.
mat3 axesOf(const CameraParams& camera);

/// The file's values of a vector per pixel, times `scale`, of unit length where they are not 0.
image::Image scaledNormals(const image::Image& normals, const vec3& scale);
/// Previous position minus this one, pixels; none where the file has none.
std::optional<vec2> motionAt(const image::Image& motion, size_t p, const Encoding& encoding);
/// Along the ray; 0 where nothing is seen.
std::vector<float> distancesOf(const ShotLayers& layers, const Encoding& encoding,
                               const CameraParams& camera);

/// Fills the frame's light: one signal or two, and emission. Returns the share of the beauty's energy that
/// diffuse, specular and emission explain; the rest becomes specular.
double addLight(const ShotLayers& layers, const std::vector<float>& distance, denoise::HostFrame& frame);
/// Makes emission finite, as nobody filters it: infinite values (a sun's disc in half precision) become the
/// largest half, other ones 0. Filtered light that is not finite stays, since denoisers leave it out; but
/// what is left of an infinite beauty without infinite emission is 0.
void limitEmission(denoise::HostFrame& frame);
/// The same for the beauty and the light groups where nothing is hit.
void limitUnfiltered(const denoise::HostFrame& frame, ShotLayers& layers);
/// Pixels with a component that is NaN or infinite.
uint64_t countNotFinite(const image::Image& colors);
/// Fills albedos; white where the file has none.
void addAlbedo(const ShotLayers& layers, denoise::HostFrame& frame);
/// On transparent film, divides light and albedo by alpha.
void divideByAlpha(const ShotLayers& layers, const std::vector<float>& distance, denoise::HostFrame& frame);
/// Fills normals, depth and ids.
void addGeometry(const ShotLayers& layers, const LayerMap& map, const std::vector<float>& distance,
                 denoise::HostFrame& frame);
/// Where the layers go on behind smooth mirrors and glass, describes light by what is seen there.
void addSeen(const ShotLayers& layers, const LayerMap& map, denoise::HostFrame& frame);

}  // namespace limpid::shot
