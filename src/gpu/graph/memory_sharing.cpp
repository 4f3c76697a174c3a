// Lets images of one frame share memory (GraphOptions::shareMemory).
#include <vector>

#include "gpu/graph/frame_graph_impl.h"

namespace limpid::gpu {
namespace {

/// The passes that access an image.
struct Lifetime {
    static constexpr size_t never = SIZE_MAX;
    size_t first = never, last = never;
    bool endsRead = false;  ///< the last pass only reads it
};

std::vector<Lifetime> lifetimesOf(const RecordedFrame& frame) {
    std::vector<Lifetime> lifetimes(frame.images.size());
    for (size_t pass = 0; pass < frame.accesses.size(); ++pass) {
        for (const Access& access : frame.accesses[pass]) {
            if (access.buffer) continue;
            Lifetime& lifetime = lifetimes[access.image];
            if (lifetime.first == Lifetime::never) lifetime.first = pass;
            lifetime.endsRead = !access.writes && (lifetime.endsRead || lifetime.last != pass);
            lifetime.last = pass;
        }
    }
    return lifetimes;
}

/// Buffers have no format.
bool sameKind(const ImageKey& a, const ImageKey& b) {
    const bool sameTexels = a.backing == Backing::Buffer ? bytesPerTexel(a.format) == bytesPerTexel(b.format)
                                                         : a.format == b.format;
    return sameTexels && a.width == b.width && a.height == b.height && a.backing == b.backing;
}

using Role = RecordedImage::Role;

}  // namespace

std::vector<uint32_t> FrameGraph::Impl::planMemory() const {
    const std::vector<RecordedImage>& images = frame.images;
    const size_t count = images.size();
    std::vector<uint32_t> memory(count);
    for (uint32_t i = 0; i < count; ++i) memory[i] = i;
    if (!options.shareMemory) return memory;
    std::vector<Lifetime> lifetimes = lifetimesOf(frame);
    for (uint32_t current = 1; current < count; ++current) {
        if (images[current].role != Role::Current) continue;
        const uint32_t previous = current - 1;  // history() creates them together
        if (lifetimes[previous].first == Lifetime::never ||
            lifetimes[previous].last >= lifetimes[current].first)
            continue;
        memory[current] = previous;
        lifetimes[previous].endsRead = false;  // holds the next frame's past: a result
    }
    const auto given = [&](uint32_t giver, uint32_t taker) {
        const bool gives = images[giver].role == Role::Transient || images[giver].role == Role::Previous;
        return gives && memory[giver] == giver && lifetimes[giver].endsRead &&
               lifetimes[giver].last < lifetimes[taker].first &&
               sameKind(images[giver].key, images[taker].key);
    };
    // Images are created about in the order of their first use, and a giver is always the older one.
    for (uint32_t taker = 0; taker < count; ++taker) {
        const bool takes = images[taker].role == Role::Transient && !images[taker].uploaded;
        if (!takes || lifetimes[taker].first == Lifetime::never) continue;
        for (uint32_t giver = 0; giver < taker; ++giver) {
            if (!given(giver, taker)) continue;
            memory[taker] = giver;
            lifetimes[giver].last = lifetimes[taker].last;  // of the memory, from here on
            lifetimes[giver].endsRead = lifetimes[taker].endsRead;
            break;
        }
    }
    return memory;
}

void FrameGraph::Impl::shareMemory() {
    if (!options.shareMemory) return;
    const std::vector<uint32_t> memory = planMemory();
    std::vector<uint32_t> users(memory.size(), UINT32_MAX);  // of each memory: the last one so far
    for (uint32_t i = 0; i < memory.size(); ++i) {
        RecordedImage& image = frame.images[i];
        if (memory[i] != i) image.sharesWith = memory[i];
        if (image.key.format != frame.images[memory[i]].key.format) image.overwritten = true;
        image.key = frame.images[memory[i]].key;
        if (users[memory[i]] != UINT32_MAX) frame.images[users[memory[i]]].overwritten = true;
        users[memory[i]] = i;
    }
    imageUses.assign(memory.size(), {});
    bufferUses.clear();
    lastBarrier = 0;
    for (size_t pass = 0; pass < frame.passes.size(); ++pass) {
        frame.passes[pass].hazards.clear();
        findHazards(frame.passes[pass], pass, frame.accesses[pass]);
    }
}

}  // namespace limpid::gpu
