// glTF textures: images and samplers to scene::Texture.
//
// Specification: glTF 2.0, section 3.8 (texture data),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#texture-data; KHR_texture_transform,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_texture_transform
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/device/texture_pool.h"
#include "scene/gltf/gltf_document.h"

namespace limpid::scene::gltf {

/// Turns the textureInfo objects of materials into TextureRefs. Only what is referred to is read and decoded.
/// An image that is missing, refused or cannot be decoded is a warning, and its textures are none.
/// Throws InputError where the document itself is wrong.
class TextureLibrary {
  public:
    TextureLibrary(Document& document, Scene& scene, uint64_t maxImageMemory)
        : document_(document),
          pool_(scene, {document.file(), TexturePool::Formats::PngAndJpeg, maxImageMemory}),
          maxImageMemory_(maxImageMemory) {}

    /// `owner.key` as a reference, none if absent or unreadable. `srgb`: the RGB texels are sRGB-encoded.
    TextureRef add(const Object& owner, const char* key, bool srgb);

    /// Warns about textures that have no image and that nothing uses.
    void checkUnused();

  private:
    int texture(int index, bool srgb);
    std::string imageName(int image) const;
    std::function<std::vector<std::byte>()> imageReader(int image);
    Sampler sampler(const Object& texture);

    Document& document_;
    TexturePool pool_;
    uint64_t maxImageMemory_;
};

}  // namespace limpid::scene::gltf
