#include "serve/web/scene_files.h"

#include <algorithm>

#include "base/error.h"
#include "scene/builtin/builtin.h"
#include "scene/load/load.h"

namespace limpid::serve {
namespace {

namespace fs = std::filesystem;

constexpr size_t maxNames = 1000;
constexpr int maxVisited = 20000;  ///< entries: the server's thread lists them

std::vector<std::string> builtinNames() {
    std::vector<std::string> names;
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) {
        if (info.name.find("-N") == std::string::npos) names.push_back("builtin:" + info.name);
    }
    return names;
}

/// Whether `file`, which is canonical, lies in `folder`.
bool isBelow(const fs::path& file, const fs::path& folder) {
    const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return end == folder.end();
}

}  // namespace

SceneFiles::SceneFiles(const fs::path& folder) {
    if (folder.empty()) return;
    std::error_code fault;
    folder_ = fs::canonical(folder, fault);
    if (fault || !fs::is_directory(folder_)) throw InputError(folder, "there is no such folder");
}

std::vector<std::string> SceneFiles::names() const {
    std::vector<std::string> names = builtinNames();
    if (folder_.empty()) return names;
    std::vector<std::string> files;
    std::error_code fault;
    int visited = 0;
    fs::recursive_directory_iterator at(folder_, fs::directory_options::skip_permission_denied, fault);
    for (; !fault && at != fs::recursive_directory_iterator() && files.size() < maxNames &&
           visited < maxVisited;
         at.increment(fault), ++visited) {
        if (at.depth() > 8) at.disable_recursion_pending();
        std::error_code unreadable;
        if (scene::isSceneFile(at->path()) && at->is_regular_file(unreadable))
            files.push_back(at->path().lexically_relative(folder_).generic_string());
    }
    std::ranges::sort(files);
    names.insert(names.end(), files.begin(), files.end());
    return names;
}

std::string SceneFiles::find(const std::string& name) const {
    const UsageError unknown("there is no such scene");
    if (name.starts_with("builtin:")) {
        const std::vector<std::string> known = builtinNames();
        if (std::ranges::find(known, name) == known.end()) throw unknown;
        return name;
    }
    // Not looked up in names(): a client may ask often, and listing a large folder takes long.
    const fs::path relative(name);
    if (folder_.empty() || name.find('\0') != std::string::npos || relative.is_absolute() ||
        !scene::isSceneFile(relative))
        throw unknown;
    std::error_code fault;
    const fs::path file = fs::canonical(folder_ / name, fault);
    // A link may lead outside.
    if (fault || !isBelow(file, folder_) || !fs::is_regular_file(file, fault)) throw unknown;
    return file.string();
}

}  // namespace limpid::serve
