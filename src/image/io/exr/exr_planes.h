// The decoded pixels of one part of an EXR file. Private to src/image.
#pragma once

#include <ImathBox.h>
#include <ImfFrameBuffer.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "image/io/exr/exr_document.h"
#include "image/io/exr/exr_values.h"

namespace limpid::image {

/// A part's channels over its data window, in the file's types.
class ExrPlanes {
  public:
    ExrPlanes() = default;
    ExrPlanes(const Imath::Box2i& data, const std::vector<ExrPart::Channel>& channels)
        : data_(data),
          width_(static_cast<size_t>(data.max.x - data.min.x) + 1),
          height_(static_cast<size_t>(data.max.y - data.min.y) + 1) {
        // Not initialised: decoding fills them, and if it fails the memory is never touched.
        for (const ExrPart::Channel& channel : channels)
            bytes_.push_back(
                std::make_unique_for_overwrite<std::byte[]>(width_ * height_ * sizeOf(channel.storage)));
    }

    bool empty() const { return bytes_.empty(); }

    /// For reading and writing; the library changes no memory when it writes a file.
    Imf::FrameBuffer frameBuffer(const std::vector<ExrPart::Channel>& channels) const {
        Imf::FrameBuffer frame;
        for (size_t c = 0; c < bytes_.size(); ++c) {
            const size_t size = sizeOf(channels[c].storage);
            // EXR addresses pixels by absolute coordinates, so its base pointer lies outside the plane. We
            // compute it as an integer, because such a pointer is undefined in C++.
            const auto base = reinterpret_cast<intptr_t>(bytes_[c].get());
            const auto rowBytes = static_cast<intptr_t>(size * width_);
            const intptr_t origin =
                base - static_cast<intptr_t>(size) * data_.min.x - rowBytes * intptr_t{data_.min.y};
            frame.insert(channels[c].name, Imf::Slice(toImf(channels[c].storage),
                                                      reinterpret_cast<char*>(origin), size, size * width_));
        }
        return frame;
    }

    float get(size_t c, Storage storage, size_t index) const {
        const std::byte* const at = bytes_[c].get() + index * sizeOf(storage);
        if (storage == Storage::Half) return static_cast<float>(load<half>(at));
        return storage == Storage::Uint ? static_cast<float>(load<uint32_t>(at)) : load<float>(at);
    }

    void set(size_t c, Storage storage, size_t index, float value) {
        std::byte* const at = bytes_[c].get() + index * sizeOf(storage);
        if (storage == Storage::Half) return store(at, toHalf(value));
        if (storage == Storage::Uint) return store(at, toUint(value));
        store(at, value);
    }

    /// Calls action(index in the plane, index in the display window) for each pixel of both windows.
    template <typename Action>
    void forShared(const Imath::Box2i& display, Action action) const {
        const size_t displayWidth = static_cast<size_t>(display.max.x - display.min.x) + 1;
        for (int y = std::max(data_.min.y, display.min.y); y <= std::min(data_.max.y, display.max.y); ++y) {
            const size_t row = static_cast<size_t>(y - data_.min.y) * width_;
            const size_t displayRow = static_cast<size_t>(y - display.min.y) * displayWidth;
            for (int x = std::max(data_.min.x, display.min.x); x <= std::min(data_.max.x, display.max.x); ++x)
                action(row + static_cast<size_t>(x - data_.min.x),
                       displayRow + static_cast<size_t>(x - display.min.x));
        }
    }

  private:
    static size_t sizeOf(Storage storage) { return storage == Storage::Half ? 2 : 4; }
    template <typename T>
    static T load(const std::byte* at) {
        T value;
        std::memcpy(&value, at, sizeof value);
        return value;
    }
    template <typename T>
    static void store(std::byte* at, T value) {
        std::memcpy(at, &value, sizeof value);
    }

    Imath::Box2i data_;
    size_t width_ = 0, height_ = 0;
    std::vector<std::unique_ptr<std::byte[]>> bytes_;
};

}  // namespace limpid::image
