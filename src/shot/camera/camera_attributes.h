// The camera in an EXR file's attributes.
#pragma once

#include <optional>
#include <string_view>

#include "image/io/exr/exr_document.h"
#include "shaders/common/camera.h"

namespace limpid::shot {

/// Limpid's own attribute (docs/layers.md), or "worldToCamera" with an angle of view: "CameraFov" (degrees,
/// horizontal) or "worldToScreen" or "worldToNDC". The matrices are for row vectors, as the OpenEXR standard
/// says (camera space: x right, y up, z forwards), or for column vectors (pbrt), which their last row and
/// column tell. None if the file says too little. Parts of another view than `view` (if it is given) are left
/// out. Throws InputError if Limpid's attribute is no camera.
std::optional<CameraParams> cameraOfAttributes(const image::ExrDocument& file, std::string_view view = {});

}  // namespace limpid::shot
