#include "gpu/vulkan/memory/image_pool.h"

#include <algorithm>

namespace limpid::gpu {
namespace {

/// Long enough to keep the images of a pass that runs every few frames.
constexpr uint64_t framesToKeep = 8;

std::string debugName(const ImageKey& key) {
    return key.half == 0 ? key.name : key.name + " (other half)";
}

}  // namespace

ImagePool::Entry& ImagePool::acquire(const ImageKey& key, const std::string& prefix) {
    auto found = entries_.find(key);
    if (found == entries_.end()) {
        Entry entry{
            makeImage(context_, prefix + debugName(key), key.format, {key.width, key.height}, key.backing)};
        found = entries_.emplace(key, std::move(entry)).first;
    }
    // Pictures are resized as a whole: images of the old size are not needed any more.
    for (auto same = entries_.lower_bound(ImageKey{.name = key.name});
         same != entries_.end() && same->first.name == key.name; ++same)
        same->second.outgrown = same->first.width != key.width || same->first.height != key.height;
    return found->second;
}

const Image* ImagePool::find(const ImageKey& key) const {
    const auto found = entries_.find(key);
    return found == entries_.end() ? nullptr : &found->second.image;
}

void ImagePool::collect(uint64_t frame) {
    std::erase_if(entries_, [&](const auto& item) {
        const Entry& entry = item.second;
        // The frame after the last one must be finished, too: what shows a picture is submitted in between.
        const uint64_t kept = entry.outgrown ? framesInFlight_ : std::max(framesInFlight_, framesToKeep);
        return !entry.initialised || entry.lastFrame + kept < frame;
    });
}

bool ImagePool::release(const std::set<ImageKey>& needed, uint64_t finished) {
    const size_t freed = std::erase_if(entries_, [&](const auto& item) {
        const auto& [key, entry] = item;
        return !needed.contains(key) && (!entry.initialised || entry.lastFrame < finished);
    });
    return freed != 0;
}

}  // namespace limpid::gpu
