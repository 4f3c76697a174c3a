#include "image/io/environment_image.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/files/file.h"
#include "base/log.h"
#include "base/text/lower_case.h"
#include "image/io/exr/exr_rows.h"
#include "image/io/hdr.h"
#include "image/io/rows/limits.h"
#include "image/io/rows/row_reducer.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;

/// Replaces invalid values in the rows of a picture and averages them into cells.
class EnvironmentBuilder {
  public:
    EnvironmentBuilder(const fs::path& path, uint64_t fileBytes, uint64_t maxMemory)
        : path_(path), fileBytes_(fileBytes), maxMemory_(maxMemory) {}

    RowSink sink() {
        return {[this](PictureSize size, uint64_t memory) { begin(size, memory); },
                [this](uint32_t y, std::span<float> row) { add(y, row); }};
    }

    Image take() {
        if (bad_ > 0)
            log::warn("{}: {} values that are not finite or below 0 were set to 0", path_.string(), bad_);
        return std::move(image_);
    }

  private:
    void begin(PictureSize size, uint64_t memory) {
        const uint64_t beside =
            fileBytes_ + memory + uint64_t{size.width} * 3 * (sizeof(double) + sizeof(float));
        const auto fits = [&](PictureSize to) {
            // While decoding, memory holds the picture twice: as decoded, and as the scene stores it.
            return to.pixels() <= maxMemory_ / environmentBytesPerPixel && beside <= maxMemory_ &&
                   to.pixels() <= (maxMemory_ - beside) / 24;
        };
        reducer_.emplace(size, 3, reductionFor(path_, size, fits, maxMemory_));
        image_ = Image(reducer_->size().width, reducer_->size().height, 3);
    }

    void add(uint32_t y, std::span<float> row) {
        for (float& value : row) {
            if (std::isfinite(value) && value >= 0.0f) continue;
            value = 0.0f;
            ++bad_;
        }
        const std::span<const float> means = reducer_->add(y, row);
        std::copy(means.begin(), means.end(), &image_.pixels[size_t{reducer_->rowOf(y)} * image_.width * 3]);
    }

    const fs::path& path_;
    uint64_t fileBytes_, maxMemory_;
    std::optional<RowReducer> reducer_;
    Image image_;
    uint64_t bad_ = 0;
};

}  // namespace

Image readEnvironmentImage(const fs::path& path, uint64_t maxMemory) {
    const std::string extension = lowerCase(path.extension().string());
    const bool isHdr = extension == ".hdr" || extension == ".pic";
    if (!isHdr && extension != ".exr")
        throw InputError(path, "is no environment map: .hdr and .exr are read");
    const std::vector<std::byte> bytes = readFile(path, maxMemory);
    EnvironmentBuilder builder(path, bytes.size(), maxMemory);
    if (isHdr) {
        decodeHdrRows(bytes, path, builder.sink(), maxStreamedPixels);
    } else {
        decodeExrRows(bytes, path, builder.sink(), maxMemory);
    }
    return builder.take();
}

}  // namespace limpid::image
