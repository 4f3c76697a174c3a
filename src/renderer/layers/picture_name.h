// What the name of a picture's file says, and how bright a PNG is.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace limpid {

/// The stops that --exposure gives, from -60 to 60; none for "auto". Throws UsageError.
std::optional<float> parseExposure(const std::string& text);

bool isExr(const std::filesystem::path& path);

/// Throws UsageError unless the name ends in .exr or .png; OutputError if no such file can be written.
void checkPictureOutput(const std::filesystem::path& path);

}  // namespace limpid
