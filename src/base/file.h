// Reading whole files, and writing so that nothing is lost when a write fails.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

namespace limpid {

/// The file's bytes. Throws InputError if it is missing, a directory, unreadable, or larger than `maxBytes`.
std::vector<std::byte> readFile(const std::filesystem::path& path, uint64_t maxBytes = uint64_t{4} << 30);

/// Calls `write` with a temporary name beside `path` (same extension), then renames the temporary onto
/// `path`. If `write` throws, or the file cannot be flushed to disk, the temporary is removed, `path` is as
/// it was, and OutputError (or what `write` threw) is thrown. Throws OutputError at once if `path` is a
/// directory or its folder does not exist.
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
