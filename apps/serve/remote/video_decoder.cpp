#include "serve/remote/video_decoder.h"

#include <vpx/vp8dx.h>
#include <vpx/vpx_decoder.h>

#include <algorithm>
#include <string>
#include <thread>

#include "base/error.h"
#include "serve/stream/yuv.h"

namespace limpid::serve {
namespace {

constexpr unsigned maxThreads = 4;

}  // namespace

struct VideoDecoder::Impl {
    vpx_codec_ctx_t codec{};
    const vpx_image_t* image = nullptr;  ///< the decoder's own, until the next frame
    ~Impl() { vpx_codec_destroy(&codec); }
};

VideoDecoder::VideoDecoder() : impl_(std::make_unique<Impl>()) {
    // As browsers: the encoder makes tiles that are decoded side by side.
    vpx_codec_dec_cfg_t config{};
    config.threads = std::clamp(std::thread::hardware_concurrency(), 1u, maxThreads);
    if (vpx_codec_dec_init(&impl_->codec, vpx_codec_vp9_dx(), &config, 0) != VPX_CODEC_OK)
        throw Error("libvpx has no VP9 decoder");
}

VideoDecoder::~VideoDecoder() = default;

void VideoDecoder::decode(std::span<const std::byte> frame) {
    const auto result = vpx_codec_decode(&impl_->codec, reinterpret_cast<const uint8_t*>(frame.data()),
                                         static_cast<unsigned>(frame.size()), nullptr, 0);
    vpx_codec_iter_t iterator = nullptr;
    impl_->image = result == VPX_CODEC_OK ? vpx_codec_get_frame(&impl_->codec, &iterator) : nullptr;
    if (!impl_->image)
        throw Error(std::string("the video cannot be decoded: ") + vpx_codec_err_to_string(result));
}

studio::Picture VideoDecoder::picture() const {
    const vpx_image_t* const image = impl_->image;
    if (!image) throw Error("no frame was decoded");
    const auto plane = [&](int number) {
        return Plane{image->planes[number], static_cast<size_t>(image->stride[number])};
    };
    return fromYuv420({image->d_w, image->d_h}, plane(VPX_PLANE_Y), plane(VPX_PLANE_U), plane(VPX_PLANE_V));
}

}  // namespace limpid::serve
