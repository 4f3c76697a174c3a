#include "serve/stream/video_encoder.h"

#include <vpx/vp8cx.h>
#include <vpx/vpx_encoder.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string>

#include "base/clock.h"
#include "base/error.h"
#include "serve/stream/yuv.h"

namespace limpid::serve {
namespace {

constexpr int timeBase = 1000;  ///< ticks a second
constexpr int speed = 9;        ///< of libvpx, for real time: 5 to 9

vpx_codec_enc_cfg_t configurationFor(gpu::Extent extent, uint32_t bitsPerSecond, uint32_t threads) {
    vpx_codec_enc_cfg_t config{};
    if (vpx_codec_enc_config_default(vpx_codec_vp9_cx(), &config, 0) != VPX_CODEC_OK)
        throw Error("libvpx has no VP9 encoder");
    config.g_w = extent.width;
    config.g_h = extent.height;
    config.g_timebase = {1, timeBase};
    config.g_threads = threads;
    config.g_lag_in_frames = 0;
    config.g_pass = VPX_RC_ONE_PASS;
    config.rc_end_usage = VPX_CBR;
    config.rc_target_bitrate = std::max(bitsPerSecond / 1000, 50u);
    config.rc_min_quantizer = 4;
    config.rc_max_quantizer = 52;
    config.rc_undershoot_pct = 50;
    config.rc_overshoot_pct = 50;
    // Milliseconds at the bitrate: a short buffer keeps single frames small.
    config.rc_buf_initial_sz = 300;
    config.rc_buf_optimal_sz = 400;
    config.rc_buf_sz = 600;
    config.kf_mode = VPX_KF_DISABLED;  // key frames come when a client needs one
    return config;
}

}  // namespace

struct VideoEncoder::Impl {
    vpx_codec_enc_cfg_t config{};
    vpx_codec_ctx_t codec{};
    vpx_image_t* image = nullptr;
    vpx_codec_pts_t time = 0;
    bool open = false;

    ~Impl() {
        if (image) vpx_img_free(image);
        if (open) vpx_codec_destroy(&codec);
    }
    void check(vpx_codec_err_t result, const char* what) {
        if (result != VPX_CODEC_OK)
            throw Error(std::string("libvpx: ") + what + ": " + vpx_codec_err_to_string(result));
    }
    void set(int control, int value) { check(vpx_codec_control_(&codec, control, value), "setting"); }
};

VideoEncoder::VideoEncoder(gpu::Extent extent, uint32_t bitsPerSecond, uint32_t threads)
    : impl_(std::make_unique<Impl>()) {
    Impl& self = *impl_;
    self.config = configurationFor(extent, bitsPerSecond, threads);
    self.check(vpx_codec_enc_init(&self.codec, vpx_codec_vp9_cx(), &self.config, 0), "opening the encoder");
    self.open = true;
    self.set(VP8E_SET_CPUUSED, speed);
    self.set(VP9E_SET_ROW_MT, 1);
    self.set(VP9E_SET_TILE_COLUMNS, extent.width >= 1024 ? 2 : extent.width >= 512 ? 1 : 0);
    self.set(VP8E_SET_STATIC_THRESHOLD, 1);  // blocks that stay the same are not searched
    self.set(VP9E_SET_AQ_MODE, 3);           // cyclic refresh: what rests becomes sharp
    self.set(VP9E_SET_COLOR_SPACE, VPX_CS_BT_709);
    self.set(VP9E_SET_COLOR_RANGE, VPX_CR_STUDIO_RANGE);
    self.set(VP8E_SET_MAX_INTRA_BITRATE_PCT, 900);
    self.image = vpx_img_alloc(nullptr, VPX_IMG_FMT_I420, extent.width, extent.height, 32);
    if (!self.image) throw Error("libvpx: out of memory");
}

VideoEncoder::~VideoEncoder() = default;

gpu::Extent VideoEncoder::extent() const {
    return {impl_->config.g_w, impl_->config.g_h};
}

void VideoEncoder::setBitrate(uint32_t bitsPerSecond) {
    const uint32_t wanted = std::max(bitsPerSecond / 1000, 50u);
    if (std::exchange(impl_->config.rc_target_bitrate, wanted) == wanted) return;
    impl_->check(vpx_codec_enc_config_set(&impl_->codec, &impl_->config), "another bitrate");
}

VideoEncoder::Frame VideoEncoder::encode(const studio::Picture& picture, bool key, double seconds) {
    Impl& self = *impl_;
    const auto begin = Clock::now();
    const auto plane = [&](int number) {
        return Plane{self.image->planes[number], static_cast<size_t>(self.image->stride[number])};
    };
    toYuv420(picture, plane(VPX_PLANE_Y), plane(VPX_PLANE_U), plane(VPX_PLANE_V));
    const auto converted = Clock::now();
    const auto ticks = std::max<vpx_codec_pts_t>(std::lround(std::clamp(seconds, 0.0, 0.2) * timeBase), 1);
    self.check(vpx_codec_encode(&self.codec, self.image, self.time, static_cast<unsigned long>(ticks),
                                key ? VPX_EFLAG_FORCE_KF : 0, VPX_DL_REALTIME),
               "encoding");
    self.time += ticks;
    Frame frame;
    vpx_codec_iter_t iterator = nullptr;
    while (const vpx_codec_cx_pkt_t* const packet = vpx_codec_get_cx_data(&self.codec, &iterator)) {
        if (packet->kind != VPX_CODEC_CX_FRAME_PKT) continue;
        const auto* const data = static_cast<const std::byte*>(packet->data.frame.buf);
        frame.bytes.insert(frame.bytes.end(), data, data + packet->data.frame.sz);
        frame.key |= (packet->data.frame.flags & VPX_FRAME_IS_KEY) != 0;
    }
    frame.convertMilliseconds = std::chrono::duration<double, std::milli>(converted - begin).count();
    frame.encodeMilliseconds = std::chrono::duration<double, std::milli>(Clock::now() - converted).count();
    return frame;
}

}  // namespace limpid::serve
