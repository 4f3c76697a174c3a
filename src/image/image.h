// Pictures in memory: named channels of 32-bit floats. Row 0 is the top.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limpid::image {

/// A picture with one to four interleaved components per pixel.
struct Image {
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t components = 3;
    std::vector<float> pixels;  ///< width * height * components

    Image() = default;
    Image(uint32_t w, uint32_t h, uint32_t c, float value = 0.0f)
        : width(w), height(h), components(c), pixels(size_t{w} * h * c, value) {}
    float& at(uint32_t x, uint32_t y, uint32_t c) { return pixels[(size_t{y} * width + x) * components + c]; }
    float at(uint32_t x, uint32_t y, uint32_t c) const {
        return pixels[(size_t{y} * width + x) * components + c];
    }
};

/// How an EXR file stores a channel.
enum class Storage { Half, Float, Uint };

/// One EXR channel: full name ("R", "normal.X") and values as floats (for Uint: exact integers below 2^24).
struct Channel {
    std::string name;
    Storage storage = Storage::Half;
    std::vector<float> values;  ///< width * height
};

/// The content of an EXR file: channels plus string attributes ("limpid.samples" = "16").
struct LayeredImage {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<Channel> channels;
    std::map<std::string, std::string> metadata;

    const Channel* find(std::string_view name) const;
    /// Adds the components of `image` as channels layer.suffixes[c] (with layer "": unprefixed names).
    void add(std::string_view layer, std::string_view suffixes, const Image& image, Storage storage);
    /// Returns channels layer.suffixes[c] as one Image. Throws Error if one is missing.
    Image get(std::string_view layer, std::string_view suffixes) const;
    /// Returns the layer with R, G and B that a viewer would show: the unnamed one, else one whose name ends
    /// in "Combined" (Blender), else the first in the file's order. None if no layer has all three.
    std::optional<std::string> colorLayer() const;
};

}  // namespace limpid::image
