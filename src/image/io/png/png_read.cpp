#include "image/io/png/png_read.h"

#include <fmt/format.h>
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <vector>

#include "base/error.h"

namespace limpid::image {

struct PngReader::State {
    std::span<const std::byte> bytes;
    size_t position = 0;
    char fault[160] = "";
    png_structp png = nullptr;
    png_infop info = nullptr;

    ~State() { png_destroy_read_struct(&png, &info, nullptr); }
};

/// libpng reports errors by longjmp, which skips destructors, so no object between here and its functions may
/// have one.
template <typename Call>
void PngReader::guarded(const Call& call) {
    if (setjmp(png_jmpbuf(state_->png)) == 0) {
        call();
        return;
    }
    throw InputError(name_, fmt::format("cannot be decoded: {}", state_->fault));
}

PngReader::PngReader(std::span<const std::byte> bytes, const std::filesystem::path& name)
    : state_(std::make_unique<State>()), name_(name) {
    state_->bytes = bytes;
    const png_error_ptr onError = [](png_structp png, png_const_charp message) {
        auto* state = static_cast<State*>(png_get_error_ptr(png));
        std::snprintf(state->fault, sizeof state->fault, "%s", message);
        png_longjmp(png, 1);
    };
    const png_error_ptr onWarning = [](png_structp, png_const_charp) {};
    const png_rw_ptr onRead = [](png_structp png, png_bytep target, size_t count) {
        auto* state = static_cast<State*>(png_get_io_ptr(png));
        if (count > state->bytes.size() - state->position) png_error(png, "it is cut off");
        std::memcpy(target, state->bytes.data() + state->position, count);
        state->position += count;
    };
    state_->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, state_.get(), onError, onWarning);
    if (!state_->png) throw Error("libpng cannot be set up");
    guarded([&] {
        state_->info = png_create_info_struct(state_->png);
        png_set_read_fn(state_->png, state_.get(), onRead);
        // image/io/rows/limits.h limits the size; libpng's own limit is a million pixels along an axis.
        png_set_user_limits(state_->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_read_info(state_->png, state_->info);
    });
}

PngReader::~PngReader() = default;

PictureSize PngReader::size() const {
    return {png_get_image_width(state_->png, state_->info), png_get_image_height(state_->png, state_->info)};
}

bool PngReader::isInterlaced() const {
    return png_get_interlace_type(state_->png, state_->info) != PNG_INTERLACE_NONE;
}

bool PngReader::has16Bits() const {
    return png_get_bit_depth(state_->png, state_->info) == 16;
}

void PngReader::begin(bool as16Bits) {
    png_structp png = state_->png;
    guarded([&] {
        png_set_expand(png);
        png_set_gray_to_rgb(png);
        if (as16Bits) {
            png_set_expand_16(png);
            png_set_add_alpha(png, 0xffff, PNG_FILLER_AFTER);
            if (std::endian::native == std::endian::little) png_set_swap(png);
        } else {
            png_set_strip_16(png);
            png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
        }
        png_set_interlace_handling(png);
        png_read_update_info(png, state_->info);
    });
}

void PngReader::readRow(uint8_t* row) {
    guarded([&] { png_read_row(state_->png, row, nullptr); });
}

void PngReader::readAll(uint8_t* pixels, size_t rowBytes) {
    if (!isInterlaced()) {
        for (uint32_t y = 0; y < size().height; ++y) readRow(pixels + y * rowBytes);
        return;
    }
    std::vector<png_bytep> rows(size().height);
    for (size_t y = 0; y < rows.size(); ++y) rows[y] = pixels + y * rowBytes;
    guarded([&] { png_read_image(state_->png, rows.data()); });
}

void PngReader::finish() {
    guarded([&] { png_read_end(state_->png, nullptr); });
}

}  // namespace limpid::image
