// What reading and writing EXR share with nobody else: the checks of a file's header that come before the
// OpenEXR library may allocate anything from it, and the library's threads. Private to src/image: users
// include image/exr.h.
#pragma once

#include <ImathBox.h>
#include <ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace limpid::image {

/// Bytes in memory as the stream that OpenEXR reads; reading beyond the end throws.
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

/// The first part's windows, in the file's coordinates (inclusive), and how many rows are decoded together.
struct ExrFrame {
    Imath::Box2i data;
    Imath::Box2i display;
    int rowsPerChunk = 1;
    uint64_t bytesPerPixel = 0;  ///< of all channels, as stored

    uint32_t width() const { return static_cast<uint32_t>(display.max.x - display.min.x) + 1; }
    uint32_t height() const { return static_cast<uint32_t>(display.max.y - display.min.y) + 1; }
};

/// Checks every header's structure and the first part's claims: windows, channels, tiles, all against the
/// file's size and image/limits.h. Throws InputError(name), or what OpenEXR throws on an attribute it
/// refuses.
ExrFrame checkExrHeaders(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// Lets OpenEXR compress and decompress on all cores, once per process, unless the program has chosen
/// already.
void useExrThreads();

}  // namespace limpid::image
