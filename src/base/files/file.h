// Reading whole files, and writing so that nothing is lost when a write fails.
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

/// Why `path` cannot be read as a file: it does not exist, is a directory, or is a pipe or a device, which
/// would block or never end. None if it can be.
std::optional<std::string> irregularity(const std::filesystem::path& path);

/// The file's bytes. Throws InputError if it is not a regular file, unreadable, or larger than `maxBytes`.
std::vector<std::byte> readFile(const std::filesystem::path& path, uint64_t maxBytes = uint64_t{4} << 30);

/// The file that an output's name stands for: symbolic links are followed, also to a file that is not there
/// yet. Throws OutputError if they lead nowhere.
std::filesystem::path linkTarget(const std::filesystem::path& path);

/// Whether two outputs would replace each other: one file by whatever names, or one name where there is none
/// yet.
bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Calls `write` with a temporary name beside linkTarget(path) (same extension), then renames the temporary
/// onto that; a symbolic link stays one. If `write` throws, or the file cannot be flushed to disk, the
/// temporary is removed, `path` is as it was, and OutputError (or what `write` threw) is thrown. Throws
/// OutputError at once if `path` is a directory, a pipe or a device, or its folder does not exist.
void writeAtomically(const std::filesystem::path& path,
                     const std::function<void(const std::filesystem::path& temporary)>& write);

/// Writes all of `text` so. Throws OutputError, as on a full disk.
void writeTextAtomically(const std::filesystem::path& path, std::string_view text);

/// Removes the temporaries of earlier writeAtomically(path) calls whose process was killed. No other process
/// may be writing `path`. What cannot be removed stays.
void removeStaleTemporaries(const std::filesystem::path& path);

/// Makes the folder, and those it is in, unless it is there. Throws OutputError if it cannot be made, or no
/// file be written in it.
void makeFolder(const std::filesystem::path& folder);

/// Throws what writeAtomically(path) would throw before any work is done: call it before a long render.
void checkWritable(const std::filesystem::path& path);

}  // namespace limpid
