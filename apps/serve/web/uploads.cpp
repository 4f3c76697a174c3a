#include "serve/web/uploads.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <system_error>

#include "base/text/lower_case.h"

namespace limpid::serve {
namespace {

namespace fs = std::filesystem;

constexpr size_t usuallyKept = 4;
constexpr size_t longestName = 100;

}  // namespace

bool isUploadName(const std::string& name) {
    constexpr std::array endings{".glb", ".gltf", ".obj", ".hdr", ".exr"};
    constexpr const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
    const std::string lower = lowerCase(name);
    return !name.empty() && name.size() <= longestName && name.front() != '.' &&
           name.find_first_not_of(allowed) == std::string::npos &&
           std::ranges::any_of(endings, [&](const char* ending) { return lower.ends_with(ending); });
}

Upload::Upload(fs::path folder, const std::string& name, uint64_t bytes)
    : folder_(std::move(folder)), file_(folder_ / name), left_(bytes) {
    std::error_code fault;
    if (fs::create_directory(folder_, fault)) stream_.open(file_, std::ios::binary);
    if (stream_.is_open()) return;
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    throw StorageError("an upload cannot be stored in " + folder_.string() +
                       (fault ? ": " + fault.message() : std::string()));
}

Upload::~Upload() {
    if (kept_) return;
    stream_.close();
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

bool Upload::write(std::span<const std::byte> bytes) {
    if (bytes.size() > left_) return false;
    // After a fault the stream ignores what follows, and Uploads::keep() throws: a request can only be
    // answered at its end.
    stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    left_ -= bytes.size();
    return true;
}

Uploads::~Uploads() {
    std::error_code ignored;
    if (!root_.empty()) fs::remove_all(root_, ignored);
}

std::unique_ptr<Upload> Uploads::begin(const std::string& name, uint64_t bytes) {
    if (!isUploadName(name) || bytes == 0 || bytes > maxBytes_) return nullptr;
    if (root_.empty()) {
        // Only its user can look into it.
        std::error_code fault;
        std::string pattern = (fs::temp_directory_path(fault) / "limpid-uploads.XXXXXX").string();
        if (fault || !::mkdtemp(pattern.data()))
            throw StorageError("there is no folder for temporary files, which uploads need");
        root_ = pattern;
    }
    return std::make_unique<Upload>(root_ / std::to_string(++ever_), name, bytes);
}

fs::path Uploads::keep(Upload& upload) {
    upload.stream_.close();
    if (!upload.stream_.good()) throw StorageError("an upload cannot be written: the disk may be full");
    upload.kept_ = true;
    kept_.push_back(upload.file());
    return upload.file();
}

void Uploads::tidy(const std::vector<std::string>& used) {
    for (size_t i = 0; i < kept_.size() && kept_.size() >= usuallyKept;) {
        if (std::ranges::find(used, kept_[i].string()) != used.end()) {
            ++i;
            continue;
        }
        std::error_code ignored;
        fs::remove_all(kept_[i].parent_path(), ignored);
        kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

}  // namespace limpid::serve
