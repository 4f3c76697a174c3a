// The device images behind the names of a frame graph, reused from frame to frame.
#pragma once

#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/memory/image.h"

namespace limpid::gpu {

class ImagePool {
  public:
    explicit ImagePool(std::shared_ptr<const Context> context) : context_(std::move(context)) {}

    struct Entry {
        Image image;
        bool initialised = false;  ///< it is in GENERAL layout
        bool zero = false;         ///< it was cleared, and no frame has written it since
        uint64_t lastFrame = 0;
    };

    /// Returns the image of this key, creating it if needed. References stay valid until the image is
    /// collected. `prefix` goes before its debug name.
    Entry& acquire(const ImageKey& key, const std::string& prefix, uint64_t frame);
    const Image* find(const ImageKey& key) const;
    /// Frees images that have not been used for a number of frames, which is larger than the number in
    /// flight. `frame` counts submitted frames.
    void collect(uint64_t frame);
    size_t size() const { return entries_.size(); }

  private:
    std::shared_ptr<const Context> context_;
    std::map<ImageKey, Entry> entries_;
};

}  // namespace limpid::gpu
