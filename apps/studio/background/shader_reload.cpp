#include "studio/background/shader_reload.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <memory>

#include "base/error.h"
#include "gpu/reflect/reflect.h"
#include "studio/state/command_line.h"

namespace limpid::studio {
namespace {

namespace fs = std::filesystem;

/// Returns the command's output, and whether it succeeded.
std::pair<std::string, bool> runCommand(const std::string& command) {
    std::FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (!pipe) throw Error("no program can be started");
    std::string output;
    std::array<char, 4096> part{};
    while (const size_t count = std::fread(part.data(), 1, part.size(), pipe))
        output.append(part.data(), count);
    return {output, ::pclose(pipe) == 0};
}

std::string includedName(const std::string& line) {
    const size_t hash = line.find_first_not_of(" \t");
    if (hash == std::string::npos || line.compare(hash, 8, "#include") != 0) return {};
    const size_t first = line.find('"', hash), last = line.rfind('"');
    return first == std::string::npos || last <= first ? std::string()
                                                       : line.substr(first + 1, last - first - 1);
}

/// What a shader's name says: its file, and an option of the compiler, " -DMACRO", or "".
std::pair<std::string, std::string> fileAndOption(const std::string& name) {
    const size_t end = std::min(name.find(' '), name.size());
    return {name.substr(0, end), name.substr(end)};
}

}  // namespace

std::vector<fs::path> includedFiles(const fs::path& folder, const fs::path& source) {
    std::vector<fs::path> found, open{source};
    while (!open.empty()) {
        const fs::path file = open.back();
        open.pop_back();
        std::ifstream stream(file);
        for (std::string line; std::getline(stream, line);) {
            const std::string name = includedName(line);
            if (name.empty()) continue;
            std::error_code none;
            fs::path included = file.parent_path() / name;
            if (!fs::exists(included, none)) included = folder / name;
            if (!fs::exists(included, none) || std::ranges::find(found, included) != found.end()) continue;
            found.push_back(included);
            open.push_back(included);
        }
    }
    return found;
}

ShaderReload::ShaderReload(fs::path folder) : folder_(std::move(folder)), started_(Time::clock::now()) {
    if (!folder_.empty() && !fs::is_directory(folder_))
        throw InputError(folder_, "is no folder; shaders are watched in Limpid's src");
}

std::optional<ShaderReload::Time> ShaderReload::savedAt(const std::string& name) const {
    const fs::path source = folder_ / fileAndOption(name).first;
    std::error_code missing;
    Time latest = fs::last_write_time(source, missing);
    if (missing) return std::nullopt;
    for (const fs::path& file : includedFiles(folder_, source)) {
        const Time saved = fs::last_write_time(file, missing);
        if (!missing) latest = std::max(latest, saved);
    }
    return latest;
}

/// Compiles with the same options as CMake (cmake/LimpidTargets.cmake), but does not optimise or strip.
std::vector<uint32_t> ShaderReload::compile(const std::string& name) const {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> binary(std::tmpfile(), std::fclose);
    if (!binary) throw Error("no temporary file can be made");
    const auto [file, option] = fileAndOption(name);
    const auto [output, succeeded] = runCommand(
        fmt::format("glslc --target-env=vulkan1.3 -g -Werror{} -I {} -o /dev/fd/{} {}", option,
                    quoted(folder_.string()), fileno(binary.get()), quoted((folder_ / file).string())));
    if (!succeeded) throw Error(output);
    std::fseek(binary.get(), 0, SEEK_END);
    std::vector<uint32_t> words(static_cast<size_t>(std::max(std::ftell(binary.get()), 0L)) /
                                sizeof(uint32_t));
    std::rewind(binary.get());
    if (words.empty() ||
        std::fread(words.data(), sizeof(uint32_t), words.size(), binary.get()) != words.size())
        throw Error("glslc wrote nothing for " + name);
    return words;
}

std::optional<ShaderReload::Result> ShaderReload::poll(const std::vector<gpu::ShaderCode>& used) {
    if (!watches()) return std::nullopt;
    bool saved = false;
    for (const gpu::ShaderCode& code : used) {
        const std::string name(code.name);
        const std::optional<Time> time = savedAt(name);
        Time& before = seen_.emplace(name, started_).first->second;
        if (!time || *time <= before) continue;
        before = *time;
        saved = true;
        pending_.insert(name);
    }
    std::set<std::string> wanted;
    for (const gpu::ShaderCode& code : used) {
        if (pending_.contains(std::string(code.name))) wanted.insert(std::string(code.name));
    }
    // Shaders with errors are not compiled again until a file is saved or other shaders are used.
    if (wanted.empty() || (!saved && wanted == tried_)) return std::nullopt;
    tried_ = wanted;
    gpu::ShaderReplacements made;
    try {
        for (const gpu::ShaderCode& code : used) {
            const std::string name(code.name);
            if (!wanted.contains(name) || made.contains(name)) continue;
            std::shared_ptr<const gpu::ShaderCode> compiled = gpu::reflect(name, compile(name));
            if (!sameInterface(compiled->reflection, code.reflection))
                throw Error(name + " declares other bindings, constants or sizes: build Limpid anew");
            made[name] = std::move(compiled);
        }
    } catch (const Error& fault) {
        return Result{0, fault.what()};
    }
    for (const std::string& name : wanted) pending_.erase(name);
    const int compiled = static_cast<int>(made.size());
    made.merge(replacements_);  // keeps the new ones
    replacements_ = std::move(made);
    return Result{compiled, {}};
}

}  // namespace limpid::studio
