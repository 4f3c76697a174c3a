// An EXR file as a whole: reads any channel of any part, replaces some, and writes all others as they were.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace limpid::image {

/// One part of an EXR file.
struct ExrPart {
    struct Channel {
        std::string name;
        Storage storage = Storage::Half;
    };
    std::string name;                ///< empty in most files with one part
    std::string view;                ///< "left", for stereo; empty without views
    std::vector<std::string> views;  ///< of the attribute "multiView": those that channels' names tell
    std::vector<Channel> channels;   ///< in the file's (alphabetical) order
    std::string compression;         ///< "zip", as in OpenEXR's documentation
    bool attached = false;           ///< not of the file: ExrDocument::attach()
    std::string unreadable;          ///< why its pixels cannot be read: "is deep"; empty if they can
    std::map<std::string, std::string> texts;
    std::map<std::string, double> numbers;
    std::map<std::string, std::array<float, 16>> matrices;  ///< row by row, as stored
};

/// Keeps the file's bytes, and decodes a part when one of its channels is first used. Pixels cover the
/// display window; outside the data window (a cropped render) they read as 0, and what is written there is
/// dropped.
class ExrDocument {
  public:
    /// Both throw InputError if the file is missing, malformed or truncated, or its claims do not fit its
    /// size (image/io/rows/limits.h). Deep parts and those with subsampled channels are unreadable, no error.
    static ExrDocument read(const std::filesystem::path& path);
    /// `name` is used in messages.
    static ExrDocument decode(std::vector<std::byte> bytes, const std::filesystem::path& name);

    /// A file with one part that has these channels, for pictures of other formats.
    static ExrDocument of(const LayeredImage& image, const std::filesystem::path& name);

    ExrDocument();  ///< of no file; only to be assigned to
    ExrDocument(ExrDocument&&) noexcept;
    ExrDocument& operator=(ExrDocument&&) noexcept;
    ~ExrDocument();

    const std::filesystem::path& name() const;
    uint32_t width() const;
    uint32_t height() const;

    /// A pixel's width over its height; 1 in most files.
    float pixelAspect() const;

    std::span<const ExrPart> parts() const;

    /// Lets the image's channels be read like those of a part of this name. They are not written, and cannot
    /// be replaced. Channels may come without values, which fill() gives those that will be read. Throws
    /// InputError(name) if the image has another size.
    void attach(const std::string& part, LayeredImage image, const std::filesystem::path& name);
    void fill(size_t part, std::string_view channel, std::vector<float> values);

    /// Decodes the part, which values() and replace() would do. Afterwards several threads may call values()
    /// of it. Throws as values() does.
    void decode(size_t part);

    /// The memory that decode() takes; 0 for parts that cannot be read.
    uint64_t decodedBytes(size_t part) const;

    /// How many pixels the part stores outside the display window (overscan). They cannot be read or
    /// replaced. 0 for parts that cannot be read.
    uint64_t pixelsOutside(size_t part) const;

    /// Returns width * height values; Uint as exact integers below 2^24. Throws InputError if the part cannot
    /// be read, and Error if there is no such channel, or an attached one has no values.
    std::vector<float> values(size_t part, std::string_view channel);

    /// The same into to[0], to[stride] and so on. Pixels outside the data window are left as they are.
    void read(size_t part, std::string_view channel, std::span<float> to, size_t stride);

    /// Replaces width * height values, which are stored in the channel's type as writeExr() does.
    void replace(size_t part, std::string_view channel, std::span<const float> values);

    /// Adds the text attribute to the part, or replaces it. A file of which no channel was replaced stays as
    /// it is.
    void setText(size_t part, const std::string& attribute, const std::string& text);

    /// Writes the file atomically. Parts, channels and attributes that were not replaced are bit for bit what
    /// they were, and so are windows, tiles, line orders and compressions, but: a changed part whose
    /// compression loses precision (b44, b44a, dwaa, dwab) becomes zip, so that its other channels do not
    /// change. Throws OutputError if the file cannot be written; InputError if a part cannot be copied or a
    /// changed one has several resolutions.
    void write(const std::filesystem::path& path) const;

  private:
    struct Content;
    explicit ExrDocument(std::unique_ptr<Content> content);
    std::unique_ptr<Content> content_;
};

}  // namespace limpid::image
