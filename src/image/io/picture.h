// Any picture file as linear radiance.
#pragma once

#include <filesystem>

#include "image/image.h"
#include "image/metrics/geometry.h"

namespace limpid::image {

struct Picture {
    Image linear;  ///< 3 components, Rec. 709 primaries; alpha is dropped
    bool sceneReferred =
        false;  ///< EXR and HDR: radiance without limit. PNG and JPEG: already exposed, in [0,1]
};

/// Reads EXR (the layer of LayeredImage::colorLayer), Radiance HDR, PNG or JPEG (decoded from sRGB); the
/// file's content decides which, not its name. Values come as they are, NaN included. Throws InputError.
Picture readPicture(const std::filesystem::path& path);

/// The same with the geometry layers that the file has (an EXR file's; others have none).
struct SequencePicture {
    Picture picture;
    Geometry geometry;
};
SequencePicture readSequencePicture(const std::filesystem::path& path);

}  // namespace limpid::image
