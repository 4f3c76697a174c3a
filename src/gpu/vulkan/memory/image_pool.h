// The device images behind the names of a frame graph, kept from frame to frame.
#pragma once

#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/memory/image.h"

namespace limpid::gpu {

class ImagePool {
  public:
    explicit ImagePool(std::shared_ptr<const Context> context) : context_(std::move(context)) {}

    struct Entry {
        Image image;
        bool initialised = false;  ///< in GENERAL layout
        uint64_t lastFrame = 0;
    };

    /// The image of this key, made if there is none. References stay valid until the image is collected.
    /// `prefix`: of its debug name.
    Entry& acquire(const ImageKey& key, const std::string& prefix, uint64_t frame);
    const Image* find(const ImageKey& key) const;
    /// Frees images that no frame has used for a while. `frame` counts submitted frames, and a while is more
    /// of them than are under way at once.
    void collect(uint64_t frame);
    size_t size() const { return entries_.size(); }

  private:
    std::shared_ptr<const Context> context_;
    std::map<ImageKey, Entry> entries_;
};

}  // namespace limpid::gpu
