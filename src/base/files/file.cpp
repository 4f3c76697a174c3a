#include "base/files/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <random>
#include <system_error>

#include "base/error.h"
#include "base/text/format.h"

namespace limpid {
namespace fs = std::filesystem;
namespace {

std::string systemMessage(int error) {
    return std::generic_category().message(error);
}

fs::path folderOf(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// The part of a temporary file's name that makes it unique, in characters.
constexpr size_t uniqueLength = 6;

std::string uniqueText() {
    constexpr std::string_view characters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
    std::random_device random;
    std::uniform_int_distribution<size_t> choose(0, characters.size() - 1);
    std::string text;
    for (size_t i = 0; i < uniqueLength; ++i) text += characters[choose(random)];
    return text;
}

/// Creates an empty file beside `path` with a name that no other process uses, and returns the name.
fs::path createTemporary(const fs::path& path) {
    constexpr int attempts = 100;
    int error = 0;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        const fs::path temporary =
            folderOf(path) / ("." + path.stem().string() + "." + uniqueText() + path.extension().string());
        // Not mkstemps(): its files are private, and the umask cannot be read without changing it, which
        // other threads would notice.
        const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0) {
            ::close(file);
            return temporary;
        }
        error = errno;
        if (error != EEXIST) break;
    }
    throw OutputError(path, "cannot create a file beside it: " + systemMessage(error));
}

/// A full disk may only be detected when data is flushed, after the writer has closed the file.
void flushToDisk(const fs::path& temporary, const fs::path& path) {
    const int file = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) throw OutputError(path, "cannot be written: " + systemMessage(errno));
    const int result = ::fsync(file);
    const int error = errno;
    ::close(file);
    if (result != 0) throw OutputError(path, "cannot be written: " + systemMessage(error));
}

}  // namespace

std::optional<std::string> irregularity(const fs::path& path) {
    std::error_code fault;
    const fs::file_status status = fs::status(path, fault);
    if (status.type() == fs::file_type::not_found) return "does not exist";
    if (status.type() == fs::file_type::none) return "cannot be opened: " + fault.message();
    if (fs::is_directory(status)) return "is a directory, not a file";
    if (!fs::is_regular_file(status)) return "is not a regular file";
    return std::nullopt;
}

std::vector<std::byte> readFile(const fs::path& path, uint64_t maxBytes) {
    if (const auto fault = irregularity(path)) throw InputError(path, *fault);
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    if (!stream) throw InputError(path, "cannot be opened: " + systemMessage(errno));
    const std::streamoff size = stream.tellg();
    if (size < 0) throw InputError(path, "cannot be read");
    if (static_cast<uint64_t>(size) > maxBytes) {
        throw InputError(path, formatText("is {} bytes long, more than the {} accepted", size, maxBytes));
    }
    std::vector<std::byte> bytes(static_cast<size_t>(size));
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(bytes.data()), size);
    if (stream.gcount() != size) throw InputError(path, "ended before its stated size");
    return bytes;
}

fs::path linkTarget(const fs::path& path) {
    constexpr int maxLinks = 40;  // same as the kernel's limit
    fs::path target = path;
    std::error_code fault;
    for (int links = 0; fs::is_symlink(fs::symlink_status(target, fault)); ++links) {
        if (links == maxLinks) throw OutputError(path, "is part of a cycle of symbolic links");
        const fs::path next = fs::read_symlink(target, fault);
        if (fault) throw OutputError(path, "is a symbolic link that cannot be read: " + fault.message());
        target = next.is_absolute() ? next : folderOf(target) / next;
    }
    return target;
}

bool isSameFile(const fs::path& a, const fs::path& b) {
    std::error_code fault;
    const fs::path targetA = linkTarget(a), targetB = linkTarget(b);
    if (fs::equivalent(targetA, targetB, fault)) return true;
    // Files that do not exist yet are the same if their folders and names are.
    return targetA.filename() == targetB.filename() &&
           fs::equivalent(folderOf(targetA), folderOf(targetB), fault);
}

void checkWritable(const fs::path& path) {
    if (path.filename().empty()) throw OutputError(path, "is a directory, not a file name");
    const fs::path target = linkTarget(path);
    std::error_code status;
    const fs::file_status there = fs::status(target, status);
    if (fs::is_directory(there)) throw OutputError(path, "is a directory, not a file name");
    if (fs::exists(there) && !fs::is_regular_file(there))
        throw OutputError(path, "is not a regular file, which alone is replaced");
    const fs::path folder = folderOf(target);
    if (!fs::is_directory(folder, status))
        throw OutputError(path, "the folder " + folder.string() + " does not exist");
    if (::access(folder.c_str(), W_OK) != 0) {
        throw OutputError(path, "the folder cannot be written: " + systemMessage(errno));
    }
}

void makeFolder(const fs::path& folder) {
    std::error_code fault;
    fs::create_directories(folder, fault);
    if (fault) throw OutputError(folder, "cannot be made: " + fault.message());
    checkWritable(folder / "file");
}

void removeStaleTemporaries(const fs::path& output) {
    const fs::path path = linkTarget(output);
    const std::string start = "." + path.stem().string() + ".", end = path.extension().string();
    std::error_code fault;
    // The increment of a range-based for throws if the folder cannot be read to its end.
    for (fs::directory_iterator entry(folderOf(path), fault); !fault && entry != fs::directory_iterator();
         entry.increment(fault)) {
        const std::string name = entry->path().filename().string();
        const bool ours = name.size() == start.size() + uniqueLength + end.size() &&
                          name.starts_with(start) && name.ends_with(end) &&
                          name.find('.', start.size()) >= start.size() + uniqueLength;
        std::error_code ignored;
        if (ours && entry->is_regular_file(ignored)) fs::remove(entry->path(), ignored);
    }
}

void writeAtomically(const fs::path& path, const std::function<void(const fs::path& temporary)>& write) {
    writeAtomicallyIf(path, [&](const fs::path& temporary) {
        write(temporary);
        return true;
    });
}

bool writeAtomicallyIf(const fs::path& path, const std::function<bool(const fs::path& temporary)>& write) {
    checkWritable(path);
    const fs::path target = linkTarget(path);
    const fs::path temporary = createTemporary(target);
    std::error_code fault;
    try {
        if (!write(temporary)) {
            fs::remove(temporary, fault);
            return false;
        }
        flushToDisk(temporary, path);
        fs::rename(temporary, target, fault);
        if (fault) throw OutputError(path, "cannot be renamed into place: " + fault.message());
        return true;
    } catch (...) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw;
    }
}

void writeTextAtomically(const fs::path& path, std::string_view text) {
    writeAtomically(path, [&](const fs::path& temporary) {
        std::ofstream stream(temporary, std::ios::binary);
        stream << text;
        stream.close();
        if (!stream) throw OutputError(path, "cannot be written: the disk may be full");
    });
}

}  // namespace limpid
