#include "scene/texture_pool.h"

#include <fmt/format.h>

#include <utility>

#include "base/error.h"
#include "image/png.h"

namespace limpid::scene {

int TexturePool::add(const std::string& key, bool srgb, const Sampler& s,
                     const std::function<std::vector<std::byte>()>& read) {
    const auto [use, isNew] =
        uses_.try_emplace(Use{key, srgb, s.wrapU, s.wrapV, s.magLinear, s.minLinear, s.mip}, none);
    if (!isNew) return use->second;
    Texture texture;
    if (const auto known = decoded_.find(key); known != decoded_.end()) {
        texture = scene_.textures[static_cast<size_t>(known->second)];
    } else {
        image::ByteImage decoded = image::decodeImage(read(), key);
        texture.width = decoded.width;
        texture.height = decoded.height;
        texture.rgba = std::move(decoded.pixels);
    }
    texels_ += uint64_t{texture.width} * texture.height;
    if (texels_ > maxTexels) {
        throw InputError(sceneFile_,
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
