#include "serve/stream/still_encoder.h"

#include <turbojpeg.h>

#include <memory>
#include <string>

#include "base/error.h"
#include "image/io/png/png.h"

namespace limpid::serve {

std::vector<std::byte> encodeJpeg(const studio::Picture& picture, int quality) {
    struct Destroy {
        void operator()(void* handle) const { tjDestroy(handle); }
    };
    const std::unique_ptr<void, Destroy> encoder(tjInitCompress());
    if (!encoder) throw Error("libjpeg-turbo cannot encode");
    const auto width = static_cast<int>(picture.extent.width),
               height = static_cast<int>(picture.extent.height);
    std::vector<std::byte> bytes(tjBufSize(width, height, TJSAMP_420));
    auto* out = reinterpret_cast<unsigned char*>(bytes.data());
    unsigned long size = bytes.size();
    if (tjCompress2(encoder.get(), reinterpret_cast<const unsigned char*>(picture.texels.data()), width, 0,
                    height, TJPF_RGBX, &out, &size, TJSAMP_420, quality,
                    TJFLAG_NOREALLOC | TJFLAG_FASTDCT) != 0)
        throw Error(std::string("libjpeg-turbo: ") + tjGetErrorStr2(encoder.get()));
    bytes.resize(size);
    return bytes;
}

std::vector<std::byte> encodeStill(const studio::Picture& picture) {
    image::ByteImage image{picture.extent.width, picture.extent.height, 3, {}};
    image.pixels.reserve(picture.texels.size() * 3);
    for (const uint32_t texel : picture.texels) {
        for (int shift = 0; shift < 24; shift += 8)
            image.pixels.push_back(static_cast<uint8_t>(texel >> shift & 0xff));
    }
    const std::vector<char> png = image::encodePng(image, "picture.png");
    const auto* const begin = reinterpret_cast<const std::byte*>(png.data());
    return {begin, begin + png.size()};
}

}  // namespace limpid::serve
