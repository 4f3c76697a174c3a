#include "image/io/pfm.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/error.h"
#include "image/io/rows/limits.h"

namespace limpid::image {
namespace {

/// Takes the words of a PFM header: separated by blanks and line feeds; one of them ends the header.
class PfmHeader {
  public:
    PfmHeader(std::span<const std::byte> bytes, const std::filesystem::path& name)
        : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name_(name) {}

    template <typename T>
    T number(const char* what) {
        const size_t begin = text_.find_first_not_of(" \t\r\n", position_);
        const size_t end = begin == std::string_view::npos ? begin : text_.find_first_of(" \t\r\n", begin);
        T value{};
        const bool found = end != std::string_view::npos && end - begin < 64;
        if (!found ||
            std::from_chars(text_.data() + begin, text_.data() + end, value).ptr != text_.data() + end)
            throw InputError(name_, fmt::format("is no valid PFM file: its {} is no number", what));
        position_ = end;
        return value;
    }

    void skipMagic() { position_ = 2; }
    /// Where the pixels begin: after one blank, or a carriage return and a line feed.
    size_t end() const {
        const bool pair =
            position_ + 1 < text_.size() && text_[position_] == '\r' && text_[position_ + 1] == '\n';
        return position_ + (pair ? 2 : 1);
    }

  private:
    std::string_view text_;
    const std::filesystem::path& name_;
    size_t position_ = 0;
};

}  // namespace

bool isPfm(std::span<const std::byte> bytes) {
    if (bytes.size() < 3) return false;
    const char last = static_cast<char>(bytes[2]);
    return static_cast<char>(bytes[0]) == 'P' && (bytes[1] == std::byte{'F'} || bytes[1] == std::byte{'f'}) &&
           (last == '\n' || last == ' ' || last == '\r' || last == '\t');
}

Image decodePfm(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    if (!isPfm(bytes)) throw InputError(name, "is no PFM file");
    const uint32_t components = bytes[1] == std::byte{'F'} ? 3 : 1;
    PfmHeader header(bytes, name);
    header.skipMagic();
    const auto width = header.number<uint32_t>("width"), height = header.number<uint32_t>("height");
    const auto scale = header.number<float>("scale");
    checkDimensions(name, width, height, bytes.size(), 1);
    const size_t floats = size_t{width} * height * components, pixels = header.end();
    if (bytes.size() < pixels || (bytes.size() - pixels) / 4 < floats)
        throw InputError(name, fmt::format("ends too early: {} bytes of pixels are needed", 4 * floats));
    const bool swapped = (scale > 0.0f) == (std::endian::native == std::endian::little);
    Image image(width, height, components);
    const size_t row = size_t{width} * components;
    for (size_t i = 0; i < floats; ++i) {
        uint32_t word = 0;
        std::memcpy(&word, bytes.data() + pixels + 4 * i, 4);
        if (swapped) word = word >> 24 | (word >> 8 & 0xFF00u) | (word << 8 & 0xFF0000u) | word << 24;
        image.pixels[(height - 1 - i / row) * row + i % row] = std::bit_cast<float>(word);
    }
    return image;
}

}  // namespace limpid::image
