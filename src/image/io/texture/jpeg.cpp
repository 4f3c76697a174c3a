#include "image/io/texture/jpeg.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <memory>

#include "base/error.h"
#include "image/io/rows/limits.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;

struct JpegHeader {
    int width = 0, height = 0, subsampling = 0, colorSpace = 0;

    PictureSize size() const { return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)}; }
    bool hasInks() const { return colorSpace == TJCS_CMYK || colorSpace == TJCS_YCCK; }
    PictureSize scaled(uint32_t divisor) const {
        const tjscalingfactor factor{1, static_cast<int>(divisor)};
        return {static_cast<uint32_t>(TJSCALED(width, factor)),
                static_cast<uint32_t>(TJSCALED(height, factor))};
    }
    /// Returns the size of all coefficients, two bytes each.
    uint64_t coefficientBytes() const {
        if (colorSpace == TJCS_GRAY) return size().pixels() * 2;
        if (hasInks() || subsampling < 0 || subsampling >= TJ_NUMSAMP) return size().pixels() * 8;
        const auto shared = static_cast<uint64_t>(tjMCUWidth[subsampling] * tjMCUHeight[subsampling]) / 64;
        return size().pixels() * 2 + size().pixels() * 4 / shared;
    }
};

/// CMYK files store inverted values, as Adobe's programs write them.
void inksToColours(std::vector<uint8_t>& pixels) {
    for (size_t i = 0; i + 3 < pixels.size(); i += 4) {
        const uint32_t key = pixels[i + 3];
        for (size_t c = 0; c < 3; ++c) pixels[i + c] = static_cast<uint8_t>(pixels[i + c] * key / 255);
        pixels[i + 3] = 255;
    }
}

class Decoder {
  public:
    Decoder(std::span<const std::byte> bytes, const fs::path& name)
        : bytes_(bytes), name_(name), handle_(tjInitDecompress(), tjDestroy) {
        if (!handle_) throw Error("libjpeg-turbo cannot be set up");
    }

    JpegHeader header() {
        JpegHeader h;
        check(tjDecompressHeader3(handle_.get(), data(), size(), &h.width, &h.height, &h.subsampling,
                                  &h.colorSpace));
        return h;
    }

    /// Decodes to RGBA; `to` is one of the header's scaled sizes.
    ByteImage decode(const JpegHeader& h, PictureSize to) {
        ByteImage image{to.width, to.height, 4, {}};
        image.pixels.resize(to.pixels() * 4);
        check(tjDecompress2(handle_.get(), data(), size(), image.pixels.data(), static_cast<int>(to.width), 0,
                            static_cast<int>(to.height), h.hasInks() ? TJPF_CMYK : TJPF_RGBA,
                            TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT));
        if (h.hasInks()) inksToColours(image.pixels);
        return image;
    }

  private:
    const unsigned char* data() const { return reinterpret_cast<const unsigned char*>(bytes_.data()); }
    unsigned long size() const { return static_cast<unsigned long>(bytes_.size()); }

    /// Treats warnings as errors: half a picture is not acceptable.
    void check(int result) {
        if (result == 0) return;
        throw InputError(name_, fmt::format("cannot be decoded: {}", tjGetErrorStr2(handle_.get())));
    }

    std::span<const std::byte> bytes_;
    const fs::path& name_;
    std::unique_ptr<void, int (*)(void*)> handle_;
};

/// Each block of 64 pixels takes at least one bit, and a block of a subsampled component may cover 4 blocks.
constexpr uint64_t pixelsPerByte = 8 * 256;

}  // namespace

ByteImage decodeJpeg(std::span<const std::byte> bytes, const fs::path& name) {
    Decoder decoder(bytes, name);
    const JpegHeader header = decoder.header();
    checkDimensions(name, header.size().width, header.size().height, bytes.size(), pixelsPerByte);
    return decoder.decode(header, header.size());
}

ByteImage decodeJpeg(std::span<const std::byte> bytes, const fs::path& name, const JpegBound& bound) {
    Decoder decoder(bytes, name);
    const JpegHeader header = decoder.header();
    const PictureSize size = header.size();
    checkDimensions(name, size.width, size.height, bytes.size(), pixelsPerByte, maxStreamedPixels);
    // Memory for rows of blocks, upsampled and not, of all components.
    const uint64_t rows = uint64_t{size.width} * 256;
    const Fits fits = bound.fits(rows + (bound.isBuffered ? header.coefficientBytes() : 0));
    uint32_t divisor = 1;
    while (divisor < 8 && !fits(header.scaled(divisor))) divisor *= 2;
    const PictureSize to = header.scaled(divisor);
    requireFits(name, to, fits, bound.maxMemory, "JPEG files are scaled down by 8 at most");
    if (divisor > 1) warnReduced(name, size, to, bound.maxMemory);
    return decoder.decode(header, to);
}

}  // namespace limpid::image
