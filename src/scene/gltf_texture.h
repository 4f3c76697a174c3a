// glTF textures: images and samplers to scene::Texture.
//
// Specification: glTF 2.0, section 3.8 (texture data),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#texture-data; KHR_texture_transform,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_texture_transform
#pragma once

#include <optional>
#include <string>

#include "scene/gltf_document.h"
#include "scene/texture_pool.h"

namespace limpid::scene::gltf {

/// Turns the textureInfo objects of materials into TextureRefs. Only what is referred to is read and decoded.
/// Throws InputError, naming the image, where an image is missing or cannot be decoded.
class TextureLibrary {
  public:
    TextureLibrary(Document& document, Scene& scene) : document_(document), pool_(document.file(), scene) {}

    /// `owner.key` as a reference, none if absent. `srgb`: the RGB texels are sRGB-encoded.
    TextureRef add(const Object& owner, const char* key, bool srgb);

    /// Warns about textures that have no image and that nothing uses.
    void checkUnused();

  private:
    int texture(int index, bool srgb);
    std::string imageName(int image) const;
    std::vector<std::byte> imageBytes(int image);
    Sampler sampler(const Object& texture);

    Document& document_;
    TexturePool pool_;
};

}  // namespace limpid::scene::gltf
