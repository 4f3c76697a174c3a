// VP9 by libvpx, set up for the shortest latency.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "studio/picture.h"

namespace limpid::serve {

class VideoEncoder {
  public:
    /// For pictures of this size. `threads`: at least 1. Throws Error if libvpx cannot.
    VideoEncoder(gpu::Extent extent, uint32_t bitsPerSecond, uint32_t threads);
    ~VideoEncoder();
    VideoEncoder(const VideoEncoder&) = delete;
    VideoEncoder& operator=(const VideoEncoder&) = delete;

    gpu::Extent extent() const;
    void setBitrate(uint32_t bitsPerSecond);
    struct Frame {
        std::vector<std::byte> bytes;
        bool key = false;
        double convertMilliseconds = 0.0, encodeMilliseconds = 0.0;
    };
    /// The next frame, which continues the last one unless `key`. `seconds`: since the last one, for the rate
    /// control.
    Frame encode(const studio::Picture& picture, bool key, double seconds);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::serve
