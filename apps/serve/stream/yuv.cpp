#include "serve/stream/yuv.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace limpid::serve {
namespace {

// BT.709: luma coefficients, and the scales of limited range, in 16 fractional bits.
constexpr double kr = 0.2126, kb = 0.0722, kg = 1.0 - kr - kb;
constexpr double lumaScale = 219.0 / 255.0, chromaScale = 224.0 / 255.0;

constexpr int fixed(double value) {
    return static_cast<int>(value * 65536.0 + (value < 0.0 ? -0.5 : 0.5));
}

constexpr int yr = fixed(kr * lumaScale), yg = fixed(kg * lumaScale), yb = fixed(kb * lumaScale);
constexpr int br = fixed(-kr / (2.0 * (1.0 - kb)) * chromaScale),
              bg = fixed(-kg / (2.0 * (1.0 - kb)) * chromaScale), bb = fixed(0.5 * chromaScale);
constexpr int rr = fixed(0.5 * chromaScale), rg = fixed(-kg / (2.0 * (1.0 - kr)) * chromaScale),
              rb = fixed(-kb / (2.0 * (1.0 - kr)) * chromaScale);
constexpr int half = 1 << 15;

constexpr uint32_t pairsTogether = 32;  ///< of rows: some 0.1 ms of work in 1920 columns

int red(uint32_t texel) {
    return static_cast<int>(texel & 0xff);
}
int green(uint32_t texel) {
    return static_cast<int>(texel >> 8 & 0xff);
}
int blue(uint32_t texel) {
    return static_cast<int>(texel >> 16 & 0xff);
}

void lumaRow(const uint32_t* texels, uint8_t* out, uint32_t width) {
    for (uint32_t x = 0; x < width; ++x) {
        const uint32_t t = texels[x];
        out[x] = static_cast<uint8_t>(16 + ((yr * red(t) + yg * green(t) + yb * blue(t) + half) >> 16));
    }
}

constexpr int chromaOffset = (128 << 18) + 2 * 65536;  ///< of sums of four, with rounding

void chromaOf(uint32_t a, uint32_t b, uint32_t c, uint32_t d, uint8_t& cb, uint8_t& cr) {
    const int r = red(a) + red(b) + red(c) + red(d), g = green(a) + green(b) + green(c) + green(d),
              bl = blue(a) + blue(b) + blue(c) + blue(d);
    cb = static_cast<uint8_t>((br * r + bg * g + bb * bl + chromaOffset) >> 18);
    cr = static_cast<uint8_t>((rr * r + rg * g + rb * bl + chromaOffset) >> 18);
}

/// `upper` and `lower`: two rows of pixels. The last column of an odd width stands apart, so that compilers
/// can vectorise the others.
void chromaRow(const uint32_t* upper, const uint32_t* lower, uint8_t* cb, uint8_t* cr, uint32_t width) {
    for (uint32_t x = 0; x < width / 2; ++x)
        chromaOf(upper[2 * x], upper[2 * x + 1], lower[2 * x], lower[2 * x + 1], cb[x], cr[x]);
    if (width % 2 == 0) return;
    const uint32_t last = width - 1;
    chromaOf(upper[last], upper[last], lower[last], lower[last], cb[width / 2], cr[width / 2]);
}

uint32_t byteOf(double value) {
    return static_cast<uint32_t>(std::clamp(std::lround(value), 0L, 255L));
}

}  // namespace

void toYuv420(const studio::Picture& picture, const Plane& y, const Plane& cb, const Plane& cr) {
    const auto [width, height] = picture.extent;
    const auto convert = [&, width = width, height = height](uint32_t pair) {
        const uint32_t row = 2 * pair, next = std::min(row + 1, height - 1);
        const uint32_t* const upper = &picture.texels[size_t{row} * width];
        const uint32_t* const lower = &picture.texels[size_t{next} * width];
        lumaRow(upper, y.data + row * y.stride, width);
        if (next != row) lumaRow(lower, y.data + next * y.stride, width);
        chromaRow(upper, lower, cb.data + pair * cb.stride, cr.data + pair * cr.stride, width);
    };
    const tbb::blocked_range<uint32_t> pairs(0, (height + 1) / 2, pairsTogether);
    tbb::parallel_for(pairs, [&](const tbb::blocked_range<uint32_t>& range) {
        for (uint32_t pair = range.begin(); pair < range.end(); ++pair) convert(pair);
    });
}

studio::Picture fromYuv420(gpu::Extent extent, const Plane& y, const Plane& cb, const Plane& cr) {
    studio::Picture picture{extent, std::vector<uint32_t>(size_t{extent.width} * extent.height)};
    for (uint32_t row = 0; row < extent.height; ++row) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const double luma = (y.data[row * y.stride + x] - 16.0) / lumaScale;
            const double b = (cb.data[row / 2 * cb.stride + x / 2] - 128.0) / chromaScale * 2.0 * (1.0 - kb);
            const double r = (cr.data[row / 2 * cr.stride + x / 2] - 128.0) / chromaScale * 2.0 * (1.0 - kr);
            const double g = -(kr * r + kb * b) / kg;
            picture.texels[size_t{row} * extent.width + x] =
                byteOf(luma + r) | byteOf(luma + g) << 8 | byteOf(luma + b) << 16 | 0xff000000u;
        }
    }
    return picture;
}

}  // namespace limpid::serve
