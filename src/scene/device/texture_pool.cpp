#include "scene/device/texture_pool.h"

#include <fmt/format.h>

#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "image/io/texture/texture_decode.h"
#include "shaders/common/scene_layout.h"

namespace limpid::scene {
namespace {

constexpr size_t maxWarnings = 16;

}  // namespace

/// Returns false if the image cannot be read. Each image is tried once, since a thousand materials may use
/// it.
bool TexturePool::decode(const std::string& key, bool srgb,
                         const std::function<std::vector<std::byte>()>& read, Texture& texture) {
    if (const auto known = decoded_.find(key); known != decoded_.end()) {
        texture = scene_.textures[static_cast<size_t>(known->second)];
        return true;
    }
    if (unreadable_.contains(key)) return false;
    try {
        image::ByteImage decoded =
            image::decodeTexture(read(), key,
                                 {.srgb = srgb,
                                  .tgaAndBmp = settings_.formats == Formats::TgaAndBmpToo,
                                  .maxMemory = settings_.maxImageMemory,
                                  .maxTexels = uint64_t{1} << layout::TEXEL_BUFFER_SHIFT});
        texture.width = decoded.width;
        texture.height = decoded.height;
        texture.rgba = std::move(decoded.pixels);
        return true;
    } catch (const InputError& fault) {
        unreadable_.insert(key);
        if (unreadable_.size() <= maxWarnings) log::warn("{}; a plain colour is used", fault.what());
        if (unreadable_.size() == maxWarnings)
            log::warn("{}: further textures that cannot be read are not listed",
                      settings_.sceneFile.string());
        return false;
    }
}

int TexturePool::add(const std::string& key, bool srgb, const Sampler& s,
                     const std::function<std::vector<std::byte>()>& read) {
    const auto [use, isNew] =
        uses_.try_emplace(Use{key, srgb, s.wrapU, s.wrapV, s.magLinear, s.minLinear, s.mip}, none);
    if (!isNew) return use->second;
    Texture texture;
    if (!decode(key, srgb, read, texture)) return none;
    texels_ += uint64_t{texture.width} * texture.height;
    if (texels_ > maxTexels) {
        throw InputError(settings_.sceneFile,
                         fmt::format("its textures have more than {} texels together", maxTexels));
    }
    texture.name = key;
    texture.srgb = srgb;
    texture.sampler = s;
    scene_.textures.push_back(std::move(texture));
    use->second = static_cast<int>(scene_.textures.size() - 1);
    decoded_.emplace(key, use->second);
    return use->second;
}

}  // namespace limpid::scene
