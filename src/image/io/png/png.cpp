#include "image/io/png/png.h"

#include <fmt/format.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>

#include "base/error.h"
#include "base/files/file.h"
#include "base/files/file_kind.h"
#include "image/io/png/png_check.h"
#include "image/io/png/png_read.h"
#include "image/io/rows/limits.h"
#include "image/io/texture/jpeg.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;

/// Decodes a PNG's pixels as RGBA, after all checks that are possible before decoding.
class WholePng {
  public:
    WholePng(std::span<const std::byte> bytes, const fs::path& name) : reader_(checked(bytes, name), name) {
        checkDimensions(name, size().width, size().height, bytes.size(), pngPixelsPerByte);
    }

    PictureSize size() const { return reader_.size(); }
    bool has16Bits() const { return reader_.has16Bits(); }

    template <typename T>
    std::vector<T> decode() {
        std::vector<T> pixels(size().pixels() * 4);
        reader_.begin(sizeof(T) == 2);
        reader_.readAll(reinterpret_cast<uint8_t*>(pixels.data()), size_t{size().width} * 4 * sizeof(T));
        reader_.finish();
        return pixels;
    }

  private:
    static std::span<const std::byte> checked(std::span<const std::byte> bytes, const fs::path& name) {
        checkPng(bytes, name);
        return bytes;
    }

    PngReader reader_;
};

uint8_t toByte(float value) {
    if (!(value > 0.0f)) return 0;  // NaN too
    return static_cast<uint8_t>(std::min(value, 1.0f) * 255.0f + 0.5f);
}

void appendBytes(void* context, void* data, int size) {
    auto* target = static_cast<std::vector<char>*>(context);
    const auto* bytes = static_cast<const char*>(data);
    target->insert(target->end(), bytes, bytes + size);
}

}  // namespace

ByteImage toBytes(const Image& encoded) {
    if (encoded.components != 1 && encoded.components != 3 && encoded.components != 4) {
        throw Error(fmt::format("an image of {} components cannot become bytes", encoded.components));
    }
    ByteImage image{encoded.width, encoded.height, std::max(3u, encoded.components), {}};
    const size_t repeat = encoded.components == 1 ? 3 : 1;
    image.pixels.reserve(encoded.pixels.size() * repeat);
    for (const float value : encoded.pixels) image.pixels.insert(image.pixels.end(), repeat, toByte(value));
    return image;
}

std::vector<char> encodePng(const ByteImage& image, const fs::path& name) {
    const uint64_t rowBytes = uint64_t{image.width} * image.components;
    const bool right = (image.components == 3 || image.components == 4) && image.width > 0 &&
                       image.height > 0 && image.pixels.size() == rowBytes * image.height;
    if (!right) throw OutputError(name, "cannot be written: a PNG needs RGB or RGBA, and at least one pixel");
    // stb_image_write uses int for sizes.
    if ((rowBytes + 1) * image.height > static_cast<uint64_t>(std::numeric_limits<int>::max())) {
        throw OutputError(
            name, fmt::format("cannot be written: {}x{} is too large for PNG", image.width, image.height));
    }
    std::vector<char> bytes;
    const int written = stbi_write_png_to_func(
        appendBytes, &bytes, static_cast<int>(image.width), static_cast<int>(image.height),
        static_cast<int>(image.components), image.pixels.data(), static_cast<int>(rowBytes));
    if (!written) throw OutputError(name, "cannot be encoded as PNG");
    return bytes;
}

void writePng(const fs::path& path, const ByteImage& image) {
    checkWritable(path);
    const std::vector<char> bytes = encodePng(image, path);
    writeAtomically(path, [&](const fs::path& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        file.close();
        if (!file) throw OutputError(path, "cannot be written: the disk may be full");
    });
}

ByteImage decodeImage(std::span<const std::byte> bytes, const fs::path& name) {
    if (looksLikeJpeg(bytes)) {
        checkJpeg(bytes, name);
        return decodeJpeg(bytes, name);
    }
    if (!looksLikePng(bytes)) throw InputError(name, "is neither PNG nor JPEG: " + describeBeginning(bytes));
    WholePng png(bytes, name);
    return {png.size().width, png.size().height, 4, png.decode<uint8_t>()};
}

ByteImage readPngOrJpeg(const fs::path& path) {
    return decodeImage(readFile(path), path);
}

Image decodeImageFloat(std::span<const std::byte> bytes, const fs::path& name) {
    const auto convert = [](uint32_t width, uint32_t height, const auto& pixels, float largest) {
        Image image(width, height, 4);
        for (size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i] = static_cast<float>(pixels[i]) / largest;
        return image;
    };
    if (looksLikePng(bytes)) {
        WholePng png(bytes, name);
        if (png.has16Bits())
            return convert(png.size().width, png.size().height, png.decode<uint16_t>(), 65535.0f);
    }
    const ByteImage image = decodeImage(bytes, name);
    return convert(image.width, image.height, image.pixels, 255.0f);
}

}  // namespace limpid::image
