#include "viewer/looks/memory.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "base/files/file.h"
#include "base/log.h"
#include "scene/load/load.h"

namespace limpid::viewer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr float narrowest = 100.0f, widest = 4000.0f;  ///< pixels, of a panel that a file may ask for

}  // namespace

void Memory::addRecent(const std::string& file) {
    if (file.starts_with("builtin:") || !scene::isSceneFile(file)) return;
    const std::string path = fs::absolute(file).lexically_normal().string();
    std::erase(recent, path);
    recent.insert(recent.begin(), path);
    if (recent.size() > mostRecent) recent.resize(mostRecent);
}

fs::path memoryFile(const fs::path& keptSettings) {
    return keptSettings.empty() ? fs::path() : keptSettings.parent_path() / "window.json";
}

Memory readMemory(const fs::path& file) {
    Memory memory;
    std::error_code none;
    if (file.empty() || !fs::exists(file, none)) return memory;
    try {
        if (const auto fault = irregularity(file)) throw std::runtime_error(*fault);
        std::ifstream stream(file);
        const json kept = json::parse(stream);
        memory.dark = kept.value("theme", "dark") != "light";
        memory.panelWidth = kept.value("panel_width", 0.0f);
        if (memory.panelWidth != 0.0f) memory.panelWidth = std::clamp(memory.panelWidth, narrowest, widest);
        memory.hdr = kept.value("hdr", memory.hdr);
        memory.paperWhite = std::clamp(kept.value("paper_white", memory.paperWhite), Memory::leastPaperWhite,
                                       Memory::mostPaperWhite);
        memory.peak = std::clamp(kept.value("peak", memory.peak), Memory::leastPeak, Memory::mostPeak);
        memory.open = kept.value("open", memory.open);
        memory.recent = kept.value("recent", memory.recent);
        memory.recent.resize(std::min(memory.recent.size(), Memory::mostRecent));
    } catch (const std::exception& fault) {
        log::warn("{}: {}; the rest of it is left out", file.string(), fault.what());
    }
    return memory;
}

void writeMemory(const fs::path& file, const Memory& memory) {
    if (file.empty()) return;
    makeFolder(fs::absolute(file).parent_path());
    const json kept{{"theme", memory.dark ? "dark" : "light"},
                    {"hdr", memory.hdr},
                    {"paper_white", memory.paperWhite},
                    {"peak", memory.peak},
                    {"panel_width", memory.panelWidth},
                    {"open", memory.open},
                    {"recent", memory.recent}};
    writeTextAtomically(file, kept.dump(1) + "\n");
}

}  // namespace limpid::viewer
