// The scenes that clients may open: the built-in ones, and those of one folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace limpid::serve {

class SceneFiles {
  public:
    /// `folder`: empty: none. Throws InputError if there is no such folder.
    explicit SceneFiles(const std::filesystem::path& folder);

    /// Built-in ones as "builtin:NAME", then the files, by path below the folder. At most 1000, among the
    /// first 20000 entries of the folder.
    std::vector<std::string> names() const;
    /// The file, or "builtin:NAME". Throws UsageError unless it is a built-in scene or a scene file in the
    /// folder: nothing outside of it is.
    std::string find(const std::string& name) const;

  private:
    std::filesystem::path folder_;  ///< canonical
};

}  // namespace limpid::serve
