#include "lab/quality/quality_sequences.h"

#include <algorithm>
#include <system_error>

#include "base/error.h"
#include "base/text/lower_case.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;

bool isGltf(const fs::path& file) {
    const std::string extension = lowerCase(file.extension().string());
    return extension == ".gltf" || extension == ".glb";
}

std::vector<fs::path> sortedEntries(const fs::path& folder) {
    std::error_code fault;
    std::vector<fs::path> entries;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault))
        entries.push_back(entry.path());
    if (fault) throw InputError(folder, "cannot be read: " + fault.message());
    std::ranges::sort(entries);
    return entries;
}

}  // namespace

const std::vector<QualitySequence>& labSequences() {
    //   name, scene, camera path, {first frame compared, frames}, samples of a reference
    static const std::vector<QualitySequence> sequences{
        {"cornell", "builtin:cornell", "orbit", {20, 36}},
        {"cornell-spheres", "builtin:cornell-spheres", "orbit", {20, 36}},
        {"cornell-moving", "builtin:cornell-moving", "orbit", {20, 36}},
        {"heavy", "builtin:heavy", "dolly", {20, 36}},
        {"moving-light", "builtin:lab-light", "none", {20, 36}},
        {"light-goes-out", "builtin:lab-switch", "none", {20, 36}},
        {"disocclusion", "builtin:lab-disocclusion", "shake", {20, 36}},
        {"mirror", "builtin:lab-mirror", "orbit", {20, 36}},
        {"textures", "builtin:lab-textures", "dolly", {20, 36}},
        {"glass", "builtin:lab-glass", "dolly", {20, 36}},
        {"many-lights", "builtin:lab-lights", "dolly", {20, 36}, 16384},
    };
    return sequences;
}

std::vector<QualitySequence> sequencesInFolder(const fs::path& folder, const fs::path& paths,
                                               const QualitySequence& common) {
    std::vector<QualitySequence> sequences;
    for (const fs::path& inner : sortedEntries(folder)) {
        std::error_code ignored;
        if (!fs::is_directory(inner, ignored)) continue;
        std::vector<fs::path> files = sortedEntries(inner);
        std::erase_if(files, [](const fs::path& file) { return !isGltf(file) || fs::is_directory(file); });
        for (const fs::path& file : files) {
            QualitySequence sequence = common;
            sequence.name = inner.filename().string();
            if (files.size() > 1) sequence.name += "-" + file.stem().string();
            sequence.scene = file.string();
            sequence.optional = true;
            const fs::path path = paths / (sequence.name + ".json");
            if (!paths.empty() && fs::exists(path)) sequence.cameraPath = path.string();
            sequences.push_back(std::move(sequence));
        }
    }
    return sequences;
}

}  // namespace limpid::cli
