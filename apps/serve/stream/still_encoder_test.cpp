#include "serve/stream/still_encoder.h"

#include <gtest/gtest.h>

#include "image/io/png/png.h"
#include "serve/stream/test_pictures.h"

namespace limpid::serve {
namespace {

TEST(StillEncoder, PngIsBitForBit) {
    for (const gpu::Extent extent : {gpu::Extent{321, 201}, gpu::Extent{1, 1}}) {
        const studio::Picture picture = noisePicture(extent);
        const image::ByteImage decoded = image::decodeImage(encodeStill(picture), "picture.png");
        EXPECT_EQ(decoded.width, extent.width);
        EXPECT_EQ(decoded.height, extent.height);
        EXPECT_EQ(studio::packedTexels(decoded), picture.texels);
    }
}

TEST(StillEncoder, JpegIsClose) {
    const studio::Picture picture = wavePicture({321, 201}, 0.0);
    const auto decoded = [&](int quality) {
        const auto bytes = encodeJpeg(picture, quality);
        return studio::Picture{picture.extent,
                               studio::packedTexels(image::decodeImage(bytes, "picture.jpg"))};
    };
    EXPECT_GT(psnr(picture, decoded(90)), 38.0);
    EXPECT_GT(psnr(picture, decoded(40)), 30.0);
    EXPECT_LT(encodeJpeg(picture, 40).size(), encodeJpeg(picture, 90).size());
}

}  // namespace
}  // namespace limpid::serve
