// The files that a scene file names: they must lie in its asset root or its own folder, so that a scene from
// the internet cannot read (or block on) anything else of this machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace limpid::scene {

/// A percent-encoded URI as text (RFC 3986, section 2.1). A '%' without two hexadecimal digits stays as it
/// is.
std::string decodePercent(std::string_view uri);

/// Resolves and reads what one scene file refers to. All errors are InputErrors with the scene file's name.
class SceneFiles {
  public:
    /// `assetRoot`: see LoadOptions. Throws InputError naming it if it is no folder.
    explicit SceneFiles(std::filesystem::path sceneFile, const std::filesystem::path& assetRoot = {});

    const std::filesystem::path& sceneFile() const { return sceneFile_; }

    /// The file that `reference` (decoded, '/' or '\' between folders) means. Throws InputError naming the
    /// reference if it has a scheme, is absolute, or leaves the asset root (and the scene's folder) by ".."
    /// or by a symbolic link. Links are followed as the system does; what counts is where the file really is.
    std::filesystem::path resolve(std::string_view reference) const;

    /// The bytes of resolve(reference). Throws InputError if it is missing, not a regular file or longer than
    /// `maxBytes`. All reads through one SceneFiles share a limit, `maxTotalBytes`.
    std::vector<std::byte> read(std::string_view reference, uint64_t maxBytes = maxTotalBytes);

    static constexpr uint64_t maxTotalBytes = uint64_t{8} << 30;

  private:
    std::filesystem::path sceneFile_;
    std::filesystem::path assetRoot_;  ///< canonical; empty: only the scene's folder
    uint64_t bytesLeft_ = maxTotalBytes;
};

/// A scene file's own bytes. Throws InputError if it is missing, a directory, not a regular file, empty or
/// too large.
std::vector<std::byte> readSceneFile(const std::filesystem::path& path);

}  // namespace limpid::scene
