// The camera as lossless text, for the attribute "limpid.camera" of EXR files, which denoisers need.
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

}  // namespace limpid
