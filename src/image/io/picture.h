// Reads any supported picture file as linear radiance.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "image/image.h"
#include "image/metrics/geometry.h"

namespace limpid::image {

struct Picture {
    Image linear;  ///< 3 components, Rec. 709 primaries; alpha is dropped
    bool sceneReferred =
        false;  ///< EXR, HDR and PFM: unbounded radiance. PNG and JPEG: already exposed, in [0,1]
};

/// The format of a picture file by its first bytes; they may still be damaged.
enum class PictureFormat { Exr, Pfm, Hdr, Png, Jpeg, Unknown };
PictureFormat formatOf(std::span<const std::byte> bytes);

/// Reads EXR (the layer of LayeredImage::colorLayer), Radiance HDR, PFM, PNG or JPEG (decoded from sRGB),
/// recognised by content, not by name. Values are not changed, not even NaN. Throws InputError.
Picture readPicture(const std::filesystem::path& path);
/// Like readPicture(), but of a file's bytes. `name` is used in messages.
Picture decodePicture(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// A picture with the geometry layers of its file (only EXR files have any).
struct SequencePicture {
    Picture picture;
    Geometry geometry;
};
SequencePicture readSequencePicture(const std::filesystem::path& path);

}  // namespace limpid::image
