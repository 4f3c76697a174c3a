// What `limpid render`, `merge` and `denoise` write: a frame's picture.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "image/tone_curve.h"
#include "renderer/layers/layers.h"
#include "renderer/layers/picture_name.h"
#include "renderer/long/sums/accumulation_header.h"

namespace limpid::cli {

/// As limpid::checkPictureOutput(), and throws UsageError unless layers go to an .exr.
void checkPictureOutput(const std::filesystem::path& path, bool layers);

/// Where --preview writes.
std::filesystem::path previewFile(std::filesystem::path output);

struct PictureFormat {
    std::vector<std::string> layers;                          ///< of an EXR, besides beauty
    bool floatColors = false;                                 ///< of an EXR; else half
    std::string exposure = "auto";                            ///< of a PNG
    image::ToneCurve toneCurve = image::ToneCurve::Standard;  ///< of a PNG
    bool shownAsIs = false;  ///< of a PNG: values are shares in [0,1], no radiance
};
PictureFormat formatOf(const AccumulationHeader& header);

/// The string attributes of an EXR; `camera` is the frame's cameraText().
std::map<std::string, std::string> metadataOf(const AccumulationHeader& header, uint64_t frame,
                                              uint64_t samples, const std::string& camera);

/// An EXR with layers and metadata, or a PNG.
void writePicture(const std::filesystem::path& path, const PictureFormat& format,
                  const RenderedLayers& layers, const std::map<std::string, std::string>& metadata);

}  // namespace limpid::cli
