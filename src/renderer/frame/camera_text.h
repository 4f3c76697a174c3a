// Camera and jitter as lossless text, for the attributes "limpid.camera" and "limpid.jitter" of EXR files,
// which denoisers read.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "shaders/common/camera.h"

namespace limpid {

inline constexpr const char* cameraAttribute = "limpid.camera";

/// "perspective origin x y z forward x y z right x y z up x y z spread s", or "orthographic ...", as
/// CameraParams has them.
std::string cameraText(const CameraParams& camera);

/// Returns nothing if the text does not have that form, or a number in it is not finite.
std::optional<CameraParams> parseCameraText(std::string_view text);

/// Where Jitter::Frame moved the rays of the frame; files of other frames lack it.
inline constexpr const char* jitterAttribute = "limpid.jitter";

/// "x y", from the pixels' centres, pixels, y down.
std::string jitterText(vec2 jitter);

/// Returns nothing if the text does not have that form, or a number is not within half a pixel.
std::optional<vec2> parseJitterText(std::string_view text);

}  // namespace limpid
