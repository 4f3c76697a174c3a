#include "image/io/texture/texture_decode.h"

#include <vector>

#include "base/error.h"
#include "base/files/file_kind.h"
#include "image/io/png/png_check.h"
#include "image/io/png/png_read.h"
#include "image/io/rows/limits.h"
#include "image/io/rows/row_reducer.h"
#include "image/io/texture/jpeg.h"
#include "image/io/texture/tga_bmp.h"
#include "image/srgb_bytes.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;

uint64_t texelsWithMipLevels(PictureSize size) {
    uint64_t sum = size.pixels();
    while (size.width > 1 || size.height > 1) {
        size = reduced(size, 2);
        sum += size.pixels();
    }
    return sum;
}

/// `whileDecoding`: bytes needed besides the result.
Fits fitsWithin(const TextureDecoding& how, uint64_t whileDecoding) {
    return [&how, whileDecoding](PictureSize to) {
        return to.pixels() <= how.maxMemory / textureBytesPerTexel && whileDecoding <= how.maxMemory &&
               to.pixels() <= (how.maxMemory - whileDecoding) / 4 && texelsWithMipLevels(to) <= how.maxTexels;
    };
}

/// Converts bytes to linear values, averages them, and converts back.
class TexelReducer {
  public:
    TexelReducer(PictureSize from, uint32_t reduction, bool srgb)
        : reducer_(from, 4, reduction), values_(size_t{from.width} * 4), srgb_(srgb) {
        image_ = {reducer_.size().width, reducer_.size().height, 4, {}};
        image_.pixels.resize(reducer_.size().pixels() * 4);
    }

    static uint64_t rowMemory(PictureSize from) { return uint64_t{from.width} * (4 + 16 + 48); }

    void add(uint32_t y, std::span<const uint8_t> row) {
        for (size_t i = 0; i < row.size(); ++i) {
            const bool isColor = i % 4 != 3;
            values_[i] = srgb_ && isColor ? table_.decode(row[i]) : static_cast<float>(row[i]) / 255.0f;
        }
        const std::span<const float> means = reducer_.add(y, values_);
        uint8_t* target = &image_.pixels[size_t{reducer_.rowOf(y)} * image_.width * 4];
        for (size_t i = 0; i < means.size(); ++i) {
            const bool isColor = i % 4 != 3;
            target[i] =
                srgb_ && isColor ? table_.encode(means[i]) : static_cast<uint8_t>(means[i] * 255.0f + 0.5f);
        }
    }

    ByteImage take() { return std::move(image_); }

  private:
    RowReducer reducer_;
    std::vector<float> values_;
    SrgbBytes table_;
    bool srgb_;
    ByteImage image_;
};

ByteImage decodePngTexture(std::span<const std::byte> bytes, const fs::path& name,
                           const TextureDecoding& how) {
    checkPng(bytes, name);
    PngReader reader(bytes, name);
    const PictureSize size = reader.size();
    checkDimensions(name, size.width, size.height, bytes.size(), pngPixelsPerByte, maxStreamedPixels);
    const uint64_t beside = bytes.size() + PngReader::rowMemory(size) + TexelReducer::rowMemory(size);
    const Fits fits = fitsWithin(how, beside);
    if (reader.isInterlaced())
        requireFits(name, size, fits, how.maxMemory, "interlaced PNG files cannot be scaled down row by row");
    const uint32_t reduction = reductionFor(name, size, fits, how.maxMemory);
    reader.begin(false);
    ByteImage image{size.width, size.height, 4, {}};
    if (reduction == 1) {
        image.pixels.resize(size.pixels() * 4);
        reader.readAll(image.pixels.data(), size_t{size.width} * 4);
    } else {
        TexelReducer reducer(size, reduction, how.srgb);
        std::vector<uint8_t> row(size_t{size.width} * 4);
        for (uint32_t y = 0; y < size.height; ++y) {
            reader.readRow(row.data());
            reducer.add(y, row);
        }
        image = reducer.take();
    }
    reader.finish();
    return image;
}

}  // namespace

ByteImage decodeTexture(std::span<const std::byte> bytes, const fs::path& name, const TextureDecoding& how) {
    const auto limit = [&](uint64_t beside) { return fitsWithin(how, bytes.size() + beside); };
    if (looksLikePng(bytes)) return decodePngTexture(bytes, name, how);
    if (looksLikeJpeg(bytes)) {
        const bool isBuffered = checkJpeg(bytes, name);
        return decodeJpeg(bytes, name, {isBuffered, limit, how.maxMemory});
    }
    if (!how.tgaAndBmp) throw InputError(name, "is neither PNG nor JPEG: " + describeBeginning(bytes));
    if (!looksLikeTga(bytes) && !looksLikeBmp(bytes))
        throw InputError(name, "is none of PNG, JPEG, TGA and BMP");
    const PictureSize size = checkTgaOrBmp(bytes, name);
    // stb_image briefly holds the file's components and RGBA together, then we do.
    requireFits(name, size, limit(size.pixels() * 4), how.maxMemory,
                "TGA and BMP files cannot be scaled down row by row, PNG files can");
    return decodeTgaOrBmp(bytes, name);
}

}  // namespace limpid::image
