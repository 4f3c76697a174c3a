// Reads whole files, and writes files so that a failed write loses nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limpid {

/// Returns why `path` cannot be read as a file: it does not exist, is a directory, or is a pipe or a device,
/// which would block or never end. None if it can be read.
std::optional<std::string> irregularity(const std::filesystem::path& path);

/// Returns the file's bytes. Throws InputError if it is not a regular file, unreadable, or larger than
/// `maxBytes`.
std::vector<std::byte> readFile(const std::filesystem::path& path, uint64_t maxBytes = uint64_t{4} << 30);

/// Returns the file that an output name refers to. Follows symbolic links, including those to a file that
/// does not exist yet. Throws OutputError if a link is broken otherwise.
std::filesystem::path linkTarget(const std::filesystem::path& path);

/// True if two outputs would overwrite each other: they are the same existing file, or the same name if
/// neither exists yet.
bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Calls `write` with a temporary name beside linkTarget(path) (same extension), then renames the temporary
/// file to the target; a symbolic link stays one. If `write` throws or the file cannot be flushed to disk,
/// removes the temporary file, leaves `path` unchanged, and throws OutputError (or what `write` threw).
/// Throws OutputError at once if `path` is a directory, a pipe or a device, or its folder does not exist.
void writeAtomically(const std::filesystem::path& path,
                     const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same, but if `write` returns false, `path` stays unchanged, too. Returns what `write` does.
bool writeAtomicallyIf(const std::filesystem::path& path,
                       const std::function<bool(const std::filesystem::path& temporary)>& write);

/// Writes `text` with writeAtomically(). Throws OutputError, for example on a full disk.
void writeTextAtomically(const std::filesystem::path& path, std::string_view text);

/// Removes temporary files left by earlier writeAtomically(path) calls whose process was killed. No other
/// process may be writing `path`. Files that cannot be removed stay.
void removeStaleTemporaries(const std::filesystem::path& path);

/// Creates the folder and its parents if they do not exist. Throws OutputError if this fails or the folder is
/// not writable.
void makeFolder(const std::filesystem::path& folder);

/// Throws what writeAtomically(path) would throw before doing any work. Call it before a long render.
void checkWritable(const std::filesystem::path& path);

}  // namespace limpid
