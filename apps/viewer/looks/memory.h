// What the window itself remembers from one time to the next: its layout and its colours. What the picture
// is made of is kept apart from it (studio/state/kept_settings.h).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace limpid::viewer {

struct Memory {
    static constexpr size_t mostRecent = 10;
    static constexpr float leastPaperWhite = 80.0f, mostPaperWhite = 500.0f, leastPeak = 200.0f,
                           mostPeak = 10000.0f;

    bool dark = true;                  ///< the theme
    bool hdr = false;                  ///< output of a high dynamic range, where the window can show one
    float paperWhite = 203.0f;         ///< cd/m^2 of white there, leastPaperWhite to mostPaperWhite
    float peak = 1000.0f;              ///< cd/m^2 of the brightest highlights, leastPeak to mostPeak
    float panelWidth = 0.0f;           ///< pixels of the window; 0: the usual width
    std::map<std::string, bool> open;  ///< sections of the panel that the user has opened or closed
    std::vector<std::string> recent;   ///< scenes that were opened, the last one first, by absolute path

    /// Puts the scene first in the list. Built-in scenes and environments do not count.
    void addRecent(const std::string& file);
    bool operator==(const Memory&) const = default;
};

/// window.json beside the file of the kept settings; empty where there is none.
std::filesystem::path memoryFile(const std::filesystem::path& keptSettings);

/// A file that is missing or damaged is nothing: what cannot be read keeps its default, with a warning.
Memory readMemory(const std::filesystem::path& file);

/// Throws OutputError. An empty name writes nothing.
void writeMemory(const std::filesystem::path& file, const Memory& memory);

}  // namespace limpid::viewer
