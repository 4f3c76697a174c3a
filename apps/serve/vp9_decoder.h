// Decodes VP9 with libvpx, for tests and measurements.
#pragma once

#include <vpx/vp8dx.h>
#include <vpx/vpx_decoder.h>

#include <span>
#include <stdexcept>

#include "serve/yuv.h"

namespace limpid::serve {

class Vp9Decoder {
  public:
    Vp9Decoder() {
        if (vpx_codec_dec_init(&codec_, vpx_codec_vp9_dx(), nullptr, 0) != VPX_CODEC_OK)
            throw std::runtime_error("libvpx has no VP9 decoder");
    }
    ~Vp9Decoder() { vpx_codec_destroy(&codec_); }
    Vp9Decoder(const Vp9Decoder&) = delete;
    Vp9Decoder& operator=(const Vp9Decoder&) = delete;

    /// Throws std::runtime_error if these bytes do not give a picture.
    studio::Picture decode(std::span<const std::byte> bytes) {
        if (vpx_codec_decode(&codec_, reinterpret_cast<const uint8_t*>(bytes.data()),
                             static_cast<unsigned>(bytes.size()), nullptr, 0) != VPX_CODEC_OK)
            throw std::runtime_error("libvpx cannot decode the frame");
        vpx_codec_iter_t iterator = nullptr;
        const vpx_image_t* const image = vpx_codec_get_frame(&codec_, &iterator);
        if (!image) throw std::runtime_error("libvpx gives no picture");
        const auto plane = [&](int number) {
            return Plane{image->planes[number], static_cast<size_t>(image->stride[number])};
        };
        return fromYuv420({image->d_w, image->d_h}, plane(VPX_PLANE_Y), plane(VPX_PLANE_U),
                          plane(VPX_PLANE_V));
    }

  private:
    vpx_codec_ctx_t codec_{};
};

}  // namespace limpid::serve
