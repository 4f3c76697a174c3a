// Small pictures of the built-in scenes, for the start page. They come with Limpid, rendered by
// scripts/render_thumbnails.sh.
#pragma once

#include <imgui.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace limpid::viewer {

/// The folder that holds them: `thumbnails` beside the program, or ../share/limpid/thumbnails as seen from
/// there; empty if there is none.
std::filesystem::path thumbnailFolder();

/// They lie in the texture of ImGui's fonts.
class Thumbnails {
  public:
    struct Place {
        ImVec2 size, from, to;  ///< pixels; coordinates in the texture
    };

    /// Reserves room in the texture. Files that cannot be read are left out, with a warning.
    void reserve(const std::filesystem::path& folder);
    /// Copies the pictures into the texture, RGBA8.
    void copy(unsigned char* texels, int width, int height);
    /// By scene name, without "builtin:".
    const std::map<std::string, Place>& places() const { return places_; }

  private:
    struct Reserved {
        std::string name;
        int rectangle;
        std::vector<unsigned char> texels;
    };
    std::vector<Reserved> reserved_;
    std::map<std::string, Place> places_;
};

}  // namespace limpid::viewer
