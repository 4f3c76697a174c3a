#include "scene/load/scene_files.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/files/file.h"
#include "scene/load/load_options.h"

namespace limpid::scene {
namespace fs = std::filesystem;
namespace {

std::optional<int> hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return std::nullopt;
}

/// Recognises a URI scheme (RFC 3986: a letter, then letters, digits, '+', '-', '.', then ':') or a drive
/// letter.
bool hasScheme(std::string_view text) {
    const size_t colon = text.find(':');
    if (colon == std::string_view::npos || colon == 0) return false;
    if (!std::isalpha(static_cast<unsigned char>(text[0]))) return false;
    return std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                       [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

/// Returns a reference for messages: shortened, and without characters that would confuse a terminal.
std::string shown(std::string_view reference) {
    std::string text(reference.substr(0, 200));
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    return "'" + text + (reference.size() > 200 ? "...'" : "'");
}

bool isInside(const fs::path& folder, const fs::path& path) {
    const auto [inFolder, inPath] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    // A path that ends with '/' has an empty last element.
    return inFolder == folder.end() || inFolder->empty();
}

fs::path folderOf(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// True if `folder` contains other users' folders or the whole system: too much for a scene file to read
/// from.
bool holdsHomeFolders(const fs::path& folder) {
    if (folder == folder.root_path() || folder == "/home" || folder == "/Users") return true;
    const passwd* user = ::getpwuid(::getuid());
    const std::array<const char*, 2> homes = {std::getenv("HOME"), user ? user->pw_dir : nullptr};
    for (const char* home : homes) {
        if (!home || !*home) continue;
        std::error_code error;
        const fs::path above = fs::weakly_canonical(home, error).parent_path();
        if (!error && isInside(folder, above)) return true;
    }
    return false;
}

}  // namespace

std::string decodePercent(std::string_view uri) {
    std::string text;
    text.reserve(uri.size());
    for (size_t i = 0; i < uri.size(); ++i) {
        const auto high = uri[i] == '%' && i + 2 < uri.size() ? hexDigit(uri[i + 1]) : std::nullopt;
        const auto low = high ? hexDigit(uri[i + 2]) : std::nullopt;
        if (low) {
            text += static_cast<char>(*high * 16 + *low);
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

fs::path defaultAssetRoot(const fs::path& sceneFile) {
    std::error_code error;
    const fs::path own = fs::weakly_canonical(folderOf(sceneFile), error);
    const fs::path above = own.parent_path();
    return error || holdsHomeFolders(above) ? own : above;
}

SceneFiles::SceneFiles(fs::path sceneFile, const fs::path& assetRoot)
    : sceneFile_(std::move(sceneFile)), used_{sceneFile_} {
    if (assetRoot.empty()) return;
    std::error_code error;
    assetRoot_ = fs::canonical(assetRoot, error);
    if (error) throw InputError(assetRoot, "cannot be the asset root: " + error.message());
    if (!fs::is_directory(assetRoot_, error)) throw InputError(assetRoot, "is no folder");
}

fs::path SceneFiles::resolve(std::string_view reference) const {
    const auto refuse = [&](const std::string& why) -> InputError {
        return InputError(sceneFile_, "refers to " + shown(reference) + ", which " + why);
    };
    if (reference.empty()) throw InputError(sceneFile_, "refers to a file with an empty name");
    if (reference.size() > 4096) throw refuse("is too long a name");
    if (reference.find('\0') != std::string_view::npos) throw refuse("has a null character in its name");
    if (hasScheme(reference)) throw refuse("is not a file's relative path (others are not read)");
    std::string text(reference);
    std::replace(text.begin(), text.end(), '\\', '/');
    const fs::path relative(text);
    if (relative.is_absolute()) throw refuse("is an absolute path (only relative ones are read)");
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(folderOf(sceneFile_), error);
    if (error) throw refuse("cannot be resolved: " + error.message());
    const fs::path target = fs::weakly_canonical(folder / relative, error);
    if (error) throw refuse("cannot be resolved: " + error.message());
    if (isInside(folder, target)) return target;
    if (assetRoot_.empty()) throw refuse("lies outside the scene's folder");
    if (isInside(assetRoot_, target)) return target;
    throw refuse("lies outside the asset root " + assetRoot_.string() + " (--asset-root)");
}

std::vector<std::byte> SceneFiles::read(std::string_view reference, uint64_t maxBytes) {
    const fs::path path = resolve(reference);
    if (const auto fault = irregularity(path))
        throw InputError(sceneFile_, "refers to " + shown(reference) + ", which " + *fault);
    used_.push_back(path);
    std::vector<std::byte> bytes = readFile(path, std::min(bytesLeft_, maxBytes));
    bytesLeft_ -= bytes.size();
    return bytes;
}

std::vector<std::byte> readSceneFile(const fs::path& path) {
    std::vector<std::byte> bytes = readFile(path);
    if (bytes.empty()) throw InputError(path, "is empty");
    return bytes;
}

}  // namespace limpid::scene
