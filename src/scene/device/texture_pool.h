// Textures of a scene, without duplicates: one per image, encoding and sampler.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "image/io/memory_bound.h"
#include "scene/model/scene.h"

namespace limpid::scene {

class TexturePool {
  public:
    /// glTF allows PNG and JPEG alone.
    enum class Formats { PngAndJpeg, TgaAndBmpToo };

    struct Settings {
        std::filesystem::path sceneFile;  ///< blamed when the textures together exceed `maxTexels`
        Formats formats = Formats::PngAndJpeg;
        uint64_t maxImageMemory = image::defaultImageMemory;
    };

    /// Appends to scene.textures.
    TexturePool(Scene& scene, Settings settings) : scene_(scene), settings_(std::move(settings)) {}

    /// The texture made of the image that `key` identifies. `read` gives the image file's bytes; it is called
    /// for the first texture of an image only. An image whose bytes cannot be had or decoded (InputError) is
    /// a warning, once, and `none`. Throws InputError if there are too many texels.
    int add(const std::string& key, bool srgb, const Sampler& sampler,
            const std::function<std::vector<std::byte>()>& read);

    uint64_t maxImageMemory() const { return settings_.maxImageMemory; }

    static constexpr uint64_t maxTexels = uint64_t{1} << 30;

  private:
    using Use = std::tuple<std::string, bool, Wrap, Wrap, bool, bool, MipFilter>;

    bool decode(const std::string& key, bool srgb, const std::function<std::vector<std::byte>()>& read,
                Texture& texture);

    Scene& scene_;
    Settings settings_;
    std::map<Use, int> uses_;
    std::map<std::string, int> decoded_;  ///< image -> a texture that holds its texels
    std::set<std::string> unreadable_;
    uint64_t texels_ = 0;
};

}  // namespace limpid::scene
