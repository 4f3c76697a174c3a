// Shaders compiled anew when their sources are saved.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gpu/graph/shader.h"

namespace limpid::studio {

/// Files that `source` includes, with those that they include, as far as they lie below `folder` (which
/// include paths start from) or beside the file that names them.
std::vector<std::filesystem::path> includedFiles(const std::filesystem::path& folder,
                                                 const std::filesystem::path& source);

class ShaderReload {
  public:
    /// `folder`: Limpid's src, which names of shaders are paths below; empty: nothing is watched. Throws
    /// InputError if there is no such folder.
    explicit ShaderReload(std::filesystem::path folder);

    bool watches() const { return !folder_.empty(); }
    /// Compiles those of `used` whose sources have been saved since the last call, with the program glslc.
    /// None of them is replaced unless all can be. None: nothing was saved.
    struct Result {
        int compiled = 0;
        std::string fault;  ///< of the compiler; empty: all is well
    };
    std::optional<Result> poll(const std::vector<gpu::ShaderCode>& used);
    const gpu::ShaderReplacements& replacements() const { return replacements_; }

  private:
    using Time = std::filesystem::file_time_type;
    /// Of a shader's source and all that it includes, the latest; none if the source is not there.
    std::optional<Time> savedAt(const std::string& name) const;
    std::vector<uint32_t> compile(const std::string& name) const;

    std::filesystem::path folder_;
    Time started_{};
    std::map<std::string, Time> seen_;
    std::set<std::string> tried_;    ///< of these, at the last attempt
    std::set<std::string> pending_;  ///< saved, and not compiled without a fault since
    gpu::ShaderReplacements replacements_;
};

}  // namespace limpid::studio
