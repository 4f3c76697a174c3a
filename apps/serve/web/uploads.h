// Files that clients send: scenes and environments, in a temporary folder that goes with the server.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"

namespace limpid::serve {

/// There is no room for a file, or its folder cannot be made.
struct StorageError : Error {
    using Error::Error;
};

/// A file that is being received. Removed with its folder unless it is finished.
class Upload {
  public:
    /// Makes the folder and an empty file. Throws StorageError if it cannot.
    Upload(std::filesystem::path folder, const std::string& name, uint64_t bytes);
    ~Upload();
    Upload(const Upload&) = delete;
    Upload& operator=(const Upload&) = delete;

    /// False: more than was announced. A full disk shows in Uploads::keep().
    bool write(std::span<const std::byte> bytes);
    bool isComplete() const { return left_ == 0; }
    const std::filesystem::path& file() const { return file_; }

  private:
    friend class Uploads;
    std::filesystem::path folder_, file_;
    std::ofstream stream_;
    uint64_t left_;
    bool kept_ = false;
};

class Uploads {
  public:
    /// `maxBytes`: of one file; 0: none is accepted.
    explicit Uploads(uint64_t maxBytes) : maxBytes_(maxBytes) {}
    ~Uploads();
    Uploads(const Uploads&) = delete;
    Uploads& operator=(const Uploads&) = delete;

    uint64_t maxBytes() const { return maxBytes_; }
    /// Null if files of this name are not accepted. Each is alone in its folder, and keeps its name: a scene
    /// is called after it. Throws StorageError if it cannot be stored.
    std::unique_ptr<Upload> begin(const std::string& name, uint64_t bytes);
    /// Keeps the file. Throws StorageError if it cannot be written.
    std::filesystem::path keep(Upload& upload);
    /// Makes room for another file: the oldest go but for those that are `used`.
    void tidy(const std::vector<std::string>& used);
    /// Nothing more can be kept before tidy().
    bool isFull() const { return kept_.size() >= mostKept; }

  private:
    static constexpr size_t mostKept = 8;
    uint64_t maxBytes_, ever_ = 0;
    std::filesystem::path root_;
    std::vector<std::filesystem::path> kept_;  ///< files, the oldest first
};

/// Whether a file may be called so: a name without a path, of letters, digits, '.', '_' and '-', not hidden,
/// with the ending of a scene in one file or of an environment, in small or capital letters.
bool isUploadName(const std::string& name);

}  // namespace limpid::serve
