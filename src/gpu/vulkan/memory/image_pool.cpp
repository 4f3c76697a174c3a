#include "gpu/vulkan/memory/image_pool.h"

namespace limpid::gpu {
namespace {

/// Long enough to keep the images of a pass that runs every few frames, short enough to free old images soon
/// after a resize.
constexpr uint64_t framesToKeep = 8;

std::string debugName(const ImageKey& key) {
    return key.half == 0 ? key.name : key.name + " (other half)";
}

}  // namespace

ImagePool::Entry& ImagePool::acquire(const ImageKey& key, const std::string& prefix, uint64_t frame) {
    auto found = entries_.find(key);
    if (found == entries_.end()) {
        Entry entry{
            makeImage(context_, prefix + debugName(key), key.format, {key.width, key.height}, key.backing)};
        found = entries_.emplace(key, std::move(entry)).first;
    }
    found->second.lastFrame = frame;
    return found->second;
}

const Image* ImagePool::find(const ImageKey& key) const {
    const auto found = entries_.find(key);
    return found == entries_.end() ? nullptr : &found->second.image;
}

void ImagePool::collect(uint64_t frame) {
    std::erase_if(entries_, [&](const auto& entry) { return entry.second.lastFrame + framesToKeep < frame; });
}

}  // namespace limpid::gpu
