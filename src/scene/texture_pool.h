// Textures of a scene, without duplicates: one per image, encoding and sampler.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "scene/scene.h"

namespace limpid::scene {

class TexturePool {
  public:
    /// Appends to scene.textures. `sceneFile` is blamed when the textures together exceed `maxTexels`.
    TexturePool(std::filesystem::path sceneFile, Scene& scene)
        : sceneFile_(std::move(sceneFile)), scene_(scene) {}

    /// The texture made of the image that `key` identifies. `read` gives the image file's bytes; it is called
    /// for the first texture of an image only. Throws InputError naming `key` if the image cannot be decoded.
    int add(const std::string& key, bool srgb, const Sampler& sampler,
            const std::function<std::vector<std::byte>()>& read);

    static constexpr uint64_t maxTexels = uint64_t{1} << 30;

  private:
    using Use = std::tuple<std::string, bool, Wrap, Wrap, bool, bool, MipFilter>;

    std::filesystem::path sceneFile_;
    Scene& scene_;
    std::map<Use, int> uses_;
    std::map<std::string, int> decoded_;  ///< image -> a texture that holds its texels
    uint64_t texels_ = 0;
};

}  // namespace limpid::scene
