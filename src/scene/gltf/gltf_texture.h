// Converts glTF images and samplers to scene::Texture.
//
// Specification: glTF 2.0, section 3.8 (texture data),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#texture-data; KHR_texture_transform,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_texture_transform
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/device/texture_pool.h"
#include "scene/gltf/document/gltf_document.h"
#include "scene/load/load_options.h"

namespace limpid::scene::gltf {

/// Converts the textureInfo objects of materials to TextureRefs. Reads and decodes only the images that are
/// used. If an image is missing, rejected or cannot be decoded, warns, and its textures become none. Throws
/// InputError if the document itself is invalid.
class TextureLibrary {
  public:
    TextureLibrary(Document& document, Scene& scene, const LoadOptions& options)
        : document_(document),
          pool_(scene, {document.file(), TexturePool::Formats::PngAndJpeg, options.maxImageMemory}),
          maxImageMemory_(options.maxImageMemory) {}

    /// Returns `owner.key` as a reference; none if absent or unreadable. `srgb`: the RGB texels are
    /// sRGB-encoded.
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
