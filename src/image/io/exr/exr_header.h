// Shared by EXR reading and writing: checks of a file's header that must precede any allocation by the
// OpenEXR library, and the library's threads. Private to src/image: users include image/exr.h.
#pragma once

#include <ImathBox.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"

namespace limpid::image {

/// A stream for OpenEXR over bytes in memory; reading beyond the end throws.
class ExrMemoryStream : public Imf::IStream {
  public:
    ExrMemoryStream(std::span<const std::byte> bytes, const std::string& name)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}
    bool read(char target[], int count) override;
    uint64_t tellg() override { return position_; }
    void seekg(uint64_t position) override { position_ = position; }

  private:
    std::span<const std::byte> bytes_;
    uint64_t position_ = 0;
};

/// The windows of a part, in the file's coordinates (inclusive), and how many rows are decoded
/// together.
struct ExrFrame {
    Imath::Box2i data;
    Imath::Box2i display;
    int rowsPerChunk = 1;
    uint64_t bytesPerPixel = 0;  ///< of all channels, as stored

    uint32_t width() const { return static_cast<uint32_t>(display.max.x - display.min.x) + 1; }
    uint32_t height() const { return static_cast<uint32_t>(display.max.y - display.min.y) + 1; }
};

/// Checks the structure of every header and the values of the first part (windows, channels, tiles) against
/// the file's size and image/limits.h. Throws InputError(name), or what OpenEXR throws on an invalid
/// attribute.
ExrFrame checkExrHeaders(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// A part of a file: its header, and its windows. `unreadable` says why its pixels cannot be decoded ("is
/// deep"); then there is no frame.
struct ExrPartHeader {
    Imf::Header header;
    ExrFrame frame;
    std::string unreadable;
};

/// Like checkExrHeaders(), but for all parts: those that cannot be read are no error. All have the same
/// display window, which is checked even if no part can be read.
std::vector<ExrPartHeader> checkExrParts(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// Runs `action`; what OpenEXR throws becomes an InputError of the file.
template <typename Action>
auto readingExr(const std::filesystem::path& name, Action action) {
    try {
        return action();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw InputError(name, "needs more memory than there is");
    } catch (const std::exception& error) {
        throw InputError(name, fmt::format("is no valid EXR file: {}", error.what()));
    }
}

/// Lets OpenEXR compress and decompress on all cores, unless the program has set a thread count. Acts once
/// per process.
void useExrThreads();

}  // namespace limpid::image
