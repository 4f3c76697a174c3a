// VP9 by libvpx: what a browser does with the stream. For measurements and tests.
#pragma once

#include <memory>
#include <span>

#include "studio/picture.h"

namespace limpid::serve {

class VideoDecoder {
  public:
    VideoDecoder();
    ~VideoDecoder();
    VideoDecoder(const VideoDecoder&) = delete;
    VideoDecoder& operator=(const VideoDecoder&) = delete;

    /// Decodes the next frame of the stream. Throws Error if it does not continue it.
    void decode(std::span<const std::byte> frame);
    /// The frame that was decoded last, in RGB; slow. Throws Error if there is none.
    studio::Picture picture() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::serve
