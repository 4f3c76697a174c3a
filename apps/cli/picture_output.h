// What `limpid render` and `limpid merge` write: a frame's picture.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "renderer/accumulation.h"
#include "renderer/accumulation_header.h"

namespace limpid::cli {

/// Stops, or nothing for "auto". Throws UsageError.
std::optional<float> parseExposure(const std::string& text);

bool isExr(const std::filesystem::path& path);

/// Throws UsageError unless the name ends in .exr or .png, and layers go to an .exr; OutputError if no such
/// file can be written.
void checkPictureOutput(const std::filesystem::path& path, bool layers);

/// The frame's means as an EXR with the header's layers, or as a PNG with its exposure.
void writePicture(const std::filesystem::path& path, const AccumulationHeader& header, uint64_t frame,
                  const FrameSums& sums);

}  // namespace limpid::cli
