// The device images behind the names of a frame graph, reused from frame to frame.
#pragma once

#include <set>

#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/memory/image.h"

namespace limpid::gpu {

class ImagePool {
  public:
    ImagePool(std::shared_ptr<const Context> context, uint64_t framesInFlight)
        : context_(std::move(context)), framesInFlight_(framesInFlight) {}

    struct Entry {
        Image image;
        bool initialised = false;  ///< it is in GENERAL layout; false: no frame has really used it
        bool zero = false;         ///< it was cleared, and no frame has written it since
        bool outgrown = false;     ///< an image of this name and another size has been asked for since
        uint64_t lastFrame = 0;    ///< the last one that used it and did not fail
    };

    /// Returns the image of this key, creating it if needed. References stay valid until the image is
    /// collected. `prefix` goes before its debug name.
    Entry& acquire(const ImageKey& key, const std::string& prefix);
    const Image* find(const ImageKey& key) const;
    /// Frees images that have not been used for a number of frames, which is larger than the number in
    /// flight; those of an earlier size once the frames in flight are over. `frame` counts submitted frames.
    void collect(uint64_t frame);
    /// Frees all images but `needed` whose last frame is before `finished`. Returns whether there were any.
    bool release(const std::set<ImageKey>& needed, uint64_t finished);
    size_t size() const { return entries_.size(); }

  private:
    std::shared_ptr<const Context> context_;
    uint64_t framesInFlight_;
    std::map<ImageKey, Entry> entries_;
};

}  // namespace limpid::gpu
