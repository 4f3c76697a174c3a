// Collects the textures of a scene without duplicates: one per image, encoding and sampler.
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

#include "image/io/rows/memory_bound.h"
#include "scene/model/scene.h"

namespace limpid::scene {

class TexturePool {
  public:
    /// glTF allows only PNG and JPEG.
    enum class Formats { PngAndJpeg, TgaAndBmpToo };

    struct Settings {
        std::filesystem::path sceneFile;  ///< named in the error if all textures together exceed `maxTexels`
        Formats formats = Formats::PngAndJpeg;
        uint64_t maxImageMemory = image::defaultImageMemory;
    };

    /// Appends textures to scene.textures.
    TexturePool(Scene& scene, Settings settings) : scene_(scene), settings_(std::move(settings)) {}

    /// Returns the index of the texture for the image identified by `key`. `read` returns the image file's
    /// bytes; it is called only for the first texture of an image. If the image cannot be read or decoded
    /// (InputError), warns once and returns `none`. Throws InputError if there are too many texels.
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
    std::map<std::string, int> decoded_;  ///< maps an image to a texture that has its texels
    std::set<std::string> unreadable_;
    uint64_t texels_ = 0;
};

}  // namespace limpid::scene
