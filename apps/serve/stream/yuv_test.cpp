#include "serve/stream/yuv.h"

#include <gtest/gtest.h>

#include <array>

#include "serve/stream/test_pictures.h"

namespace limpid::serve {
namespace {

struct Planes {
    explicit Planes(gpu::Extent e)
        : half{(e.width + 1) / 2, (e.height + 1) / 2},
          y(size_t{e.width} * e.height),
          cb(size_t{half.width} * half.height),
          cr(cb.size()),
          width(e.width) {}
    Plane yPlane() { return {y.data(), width}; }
    Plane cbPlane() { return {cb.data(), half.width}; }
    Plane crPlane() { return {cr.data(), half.width}; }

    gpu::Extent half;
    std::vector<uint8_t> y, cb, cr;
    size_t width;
};

struct Ycc {
    double y, cb, cr;
};

/// ITU-R BT.709-6, items 3.2 to 3.4, for 8 bits.
Ycc bt709(double r, double g, double b) {
    r /= 255.0, g /= 255.0, b /= 255.0;
    const double y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    return {219.0 * y + 16.0, 224.0 * (b - y) / 1.8556 + 128.0, 224.0 * (r - y) / 1.5748 + 128.0};
}

Ycc meanOf(const studio::Picture& picture, uint32_t x, uint32_t y, uint32_t size) {
    double r = 0.0, g = 0.0, b = 0.0;
    for (uint32_t i = 0; i < size * size; ++i) {
        const uint32_t column = std::min(x + i % size, picture.extent.width - 1);
        const uint32_t row = std::min(y + i / size, picture.extent.height - 1);
        const uint32_t texel = picture.texels[size_t{row} * picture.extent.width + column];
        r += texel & 0xff, g += texel >> 8 & 0xff, b += texel >> 16 & 0xff;
    }
    const double count = size * size;
    return bt709(r / count, g / count, b / count);
}

TEST(Yuv, IsBt709ToOneLevel) {
    for (const gpu::Extent extent :
         {gpu::Extent{64, 48}, gpu::Extent{321, 201}, gpu::Extent{1, 1}, gpu::Extent{2, 7}}) {
        const studio::Picture picture = noisePicture(extent);
        Planes planes(extent);
        toYuv420(picture, planes.yPlane(), planes.cbPlane(), planes.crPlane());
        double worst = 0.0;
        for (uint32_t y = 0; y < extent.height; ++y) {
            for (uint32_t x = 0; x < extent.width; ++x)
                worst =
                    std::max(worst, std::abs(planes.y[y * planes.width + x] - meanOf(picture, x, y, 1).y));
        }
        for (uint32_t y = 0; y < planes.half.height; ++y) {
            for (uint32_t x = 0; x < planes.half.width; ++x) {
                const Ycc expected = meanOf(picture, 2 * x, 2 * y, 2);
                const size_t at = size_t{y} * planes.half.width + x;
                worst = std::max(
                    {worst, std::abs(planes.cb[at] - expected.cb), std::abs(planes.cr[at] - expected.cr)});
            }
        }
        EXPECT_LE(worst, 1.0) << extent.width << "x" << extent.height;
    }
}

TEST(Yuv, KnowsTheLimits) {
    const auto levels = [](uint32_t texel) {
        Planes planes({1, 1});
        toYuv420({{1, 1}, {texel}}, planes.yPlane(), planes.cbPlane(), planes.crPlane());
        return std::array{planes.y[0], planes.cb[0], planes.cr[0]};
    };
    EXPECT_EQ(levels(0xff000000u), (std::array<uint8_t, 3>{16, 128, 128}));
    EXPECT_EQ(levels(0xffffffffu), (std::array<uint8_t, 3>{235, 128, 128}));
    EXPECT_EQ(levels(0xff0000ffu)[2], 240) << "red";
    EXPECT_EQ(levels(0xffff0000u)[1], 240) << "blue";
}

TEST(Yuv, ComesBack) {
    const studio::Picture picture = wavePicture({321, 201}, 0.0);
    Planes planes(picture.extent);
    toYuv420(picture, planes.yPlane(), planes.cbPlane(), planes.crPlane());
    EXPECT_GT(psnr(picture, fromYuv420(picture.extent, planes.yPlane(), planes.cbPlane(), planes.crPlane())),
              38.0);
}

}  // namespace
}  // namespace limpid::serve
