#include "viewer/start/thumbnails.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/log.h"
#include "image/color.h"
#include "image/io/picture.h"

namespace limpid::viewer {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t longestSide = 512;  ///< pixels

std::vector<unsigned char> texelsOf(const image::Image& picture) {
    std::vector<unsigned char> texels;
    texels.reserve(4 * size_t{picture.width} * picture.height);
    for (uint32_t y = 0; y < picture.height; ++y) {
        for (uint32_t x = 0; x < picture.width; ++x) {
            for (uint32_t c = 0; c < 3; ++c) {
                const float value = image::srgbEncode(std::clamp(picture.at(x, y, c), 0.0f, 1.0f));
                texels.push_back(static_cast<unsigned char>(std::lround(255.0f * value)));
            }
            texels.push_back(255);
        }
    }
    return texels;
}

}  // namespace

fs::path thumbnailFolder() {
    std::error_code fault;
    const fs::path folder = fs::read_symlink("/proc/self/exe", fault).parent_path();
    if (folder.empty()) return {};
    for (const fs::path& candidate :
         {folder / "thumbnails", folder.parent_path() / "share" / "limpid" / "thumbnails"})
        if (fs::is_directory(candidate, fault)) return candidate;
    return {};
}

void Thumbnails::reserve(const fs::path& folder) {
    std::error_code fault;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
        if (entry.path().extension() != ".png") continue;
        try {
            const image::Image picture = image::readPicture(entry.path()).linear;
            if (std::max(picture.width, picture.height) > longestSide)
                throw InputError(entry.path(), "too large");
            const int rectangle = ImGui::GetIO().Fonts->AddCustomRectRegular(
                static_cast<int>(picture.width), static_cast<int>(picture.height));
            reserved_.push_back({entry.path().stem().string(), rectangle, texelsOf(picture)});
        } catch (const Error& error) {
            log::warn("{}", error.what());
        }
    }
}

void Thumbnails::copy(unsigned char* texels, int width, int height) {
    for (const Reserved& picture : reserved_) {
        const ImFontAtlasCustomRect& at = *ImGui::GetIO().Fonts->GetCustomRectByIndex(picture.rectangle);
        const size_t row = size_t{4} * at.Width;
        for (size_t y = 0; y < at.Height; ++y)
            std::memcpy(texels + 4 * ((at.Y + y) * static_cast<size_t>(width) + at.X),
                        picture.texels.data() + y * row, row);
        const auto w = static_cast<float>(width), h = static_cast<float>(height);
        places_[picture.name] = {
            {static_cast<float>(at.Width), static_cast<float>(at.Height)},
            {static_cast<float>(at.X) / w, static_cast<float>(at.Y) / h},
            {static_cast<float>(at.X + at.Width) / w, static_cast<float>(at.Y + at.Height) / h}};
    }
    reserved_.clear();
}

}  // namespace limpid::viewer
