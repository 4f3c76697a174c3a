#include "image/jpeg.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <memory>

#include "base/error.h"
#include "image/limits.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;

struct Header {
    int width = 0, height = 0, colorSpace = 0;
};

class Decoder {
  public:
    Decoder(std::span<const std::byte> bytes, const fs::path& name)
        : bytes_(bytes), name_(name), handle_(tjInitDecompress(), tjDestroy) {
        if (!handle_) throw Error("libjpeg-turbo cannot be set up");
    }

    Header header() {
        Header h;
        int subsampling = 0;
        check(tjDecompressHeader3(handle_.get(), data(), size(), &h.width, &h.height, &subsampling,
                                  &h.colorSpace));
        return h;
    }

    void decode(const Header& h, int format, uint8_t* pixels) {
        check(tjDecompress2(handle_.get(), data(), size(), pixels, h.width, 0, h.height, format,
                            TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT));
    }

  private:
    const unsigned char* data() const { return reinterpret_cast<const unsigned char*>(bytes_.data()); }
    unsigned long size() const { return static_cast<unsigned long>(bytes_.size()); }

    /// Warnings too: half a picture is no picture.
    void check(int result) {
        if (result == 0) return;
        throw InputError(name_, fmt::format("cannot be decoded: {}", tjGetErrorStr2(handle_.get())));
    }

    std::span<const std::byte> bytes_;
    const fs::path& name_;
    std::unique_ptr<void, int (*)(void*)> handle_;
};

/// Files of four inks hold them inverted, as Adobe's programs write them.
void inksToColours(std::vector<uint8_t>& pixels) {
    for (size_t i = 0; i + 3 < pixels.size(); i += 4) {
        const uint32_t key = pixels[i + 3];
        for (size_t c = 0; c < 3; ++c) pixels[i + c] = static_cast<uint8_t>(pixels[i + c] * key / 255);
        pixels[i + 3] = 255;
    }
}

}  // namespace

ByteImage decodeJpeg(std::span<const std::byte> bytes, const fs::path& name) {
    Decoder decoder(bytes, name);
    const Header header = decoder.header();
    const auto width = static_cast<uint32_t>(header.width), height = static_cast<uint32_t>(header.height);
    // At least a bit per block of 64 pixels, and that for a subsampled colour may stand for 4 blocks.
    checkDimensions(name, width, height, bytes.size(), 8 * 256);
    ByteImage image{width, height, 4, {}};
    image.pixels.resize(size_t{width} * height * 4);
    const bool inks = header.colorSpace == TJCS_CMYK || header.colorSpace == TJCS_YCCK;
    decoder.decode(header, inks ? TJPF_CMYK : TJPF_RGBA, image.pixels.data());
    if (inks) inksToColours(image.pixels);
    return image;
}

}  // namespace limpid::image
