// Converts sRGB-encoded bytes from and to linear values with tables. Private to src/image.
#pragma once

#include <array>
#include <cstdint>

#include "image/color.h"

namespace limpid::image {

/// Gives the same results as rounding srgbEncode(linear) * 255, without a power function per value.
class SrgbBytes {
  public:
    SrgbBytes() {
        for (size_t b = 0; b < linear_.size(); ++b) {
            linear_[b] = srgbDecode(static_cast<float>(b) / 255.0f);
            from_[b] = b == 0 ? 0.0f : srgbDecode((static_cast<float>(b) - 0.5f) / 255.0f);
        }
        for (size_t i = 0, b = 0; i < start_.size(); ++i) {
            while (b < 255 && from_[b + 1] <= static_cast<float>(i) / cells) ++b;
            start_[i] = static_cast<uint8_t>(b);
        }
    }

    float decode(uint8_t byte) const { return linear_[byte]; }

    uint8_t encode(float linear) const {
        const float clamped = linear > 0.0f ? (linear < 1.0f ? linear : 1.0f) : 0.0f;
        size_t b = start_[static_cast<size_t>(clamped * cells)];
        while (b < 255 && from_[b + 1] <= clamped) ++b;
        return static_cast<uint8_t>(b);
    }

  private:
    static constexpr float cells = 4096.0f;
    std::array<float, 256> linear_{};
    std::array<float, 256> from_{};      ///< smallest linear value that rounds to this byte
    std::array<uint8_t, 4097> start_{};  ///< by linear value times `cells`: where the search starts
};

}  // namespace limpid::image
