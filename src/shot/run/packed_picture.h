// A clean picture in seven bytes per pixel, for those that wait for the other direction.
#pragma once

#include <cstdint>
#include <vector>

#include "shot/frame/clean_picture.h"

namespace limpid::shot {

class PackedPicture {
  public:
    /// Keeps colours and alpha in half precision, and histories up to 255 frames. A pixel that is too bright
    /// for half precision gets no history, so that merge() takes the other direction's.
    explicit PackedPicture(const CleanPicture& picture);
    CleanPicture unpacked() const;

  private:
    std::vector<uint16_t> colors_, alpha_;
    std::vector<uint8_t> frames_;
};

}  // namespace limpid::shot
