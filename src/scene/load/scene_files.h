// Finds the files that a scene file refers to. They must lie in its asset root or its own folder, so that a
// scene from the internet cannot read (or block on) anything else on this machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace limpid::scene {

/// Decodes a percent-encoded URI (RFC 3986, section 2.1). A '%' without two hexadecimal digits is kept.
std::string decodePercent(std::string_view uri);

/// Resolves and reads the files that one scene file refers to. All errors are InputErrors with the scene
/// file's name.
class SceneFiles {
  public:
    /// `assetRoot`: see LoadOptions. Throws InputError naming it if it is not a folder.
    explicit SceneFiles(std::filesystem::path sceneFile, const std::filesystem::path& assetRoot = {});

    const std::filesystem::path& sceneFile() const { return sceneFile_; }
    /// The scene file, and all that read() was asked for and found.
    const std::vector<std::filesystem::path>& used() const { return used_; }

    /// Returns the file for `reference` (decoded, '/' or '\' between folders). Throws InputError naming the
    /// reference if it has a scheme, is absolute, or leaves the asset root (and the scene's folder) through
    /// ".." or a symbolic link. Links are followed like the system does; the file's real location counts.
    std::filesystem::path resolve(std::string_view reference) const;

    /// Returns the bytes of resolve(reference). Throws InputError if the file is missing, not a regular file
    /// or longer than `maxBytes`. All reads of one SceneFiles share the limit `maxTotalBytes`.
    std::vector<std::byte> read(std::string_view reference, uint64_t maxBytes = maxTotalBytes);

    static constexpr uint64_t maxTotalBytes = uint64_t{8} << 30;

  private:
    std::filesystem::path sceneFile_;
    std::filesystem::path assetRoot_;  ///< canonical; empty: only the scene's folder
    std::vector<std::filesystem::path> used_;
    uint64_t bytesLeft_ = maxTotalBytes;
};

/// Reads the scene file itself. Throws InputError if it is missing, a directory, not a regular file, empty or
/// too large.
std::vector<std::byte> readSceneFile(const std::filesystem::path& path);

}  // namespace limpid::scene
