// The messages of docs/serve-protocol.md, to and from bytes. Does not use the network.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "studio/session.h"

namespace limpid::serve {

/// Of one message. An edit of a light repeats all lights of the scene, about 250 bytes each.
inline constexpr size_t maxTextBytes = size_t{1} << 20;
/// Of the viewport: a renderer needs hundreds of bytes for each. 5120x2880 is allowed.
inline constexpr uint64_t maxPixels = uint64_t{1} << 24;

/// Motion: no picture, but what motionGrid() makes.
enum class Codec : uint8_t { Vp9 = 1, Jpeg = 2, Png = 3, Motion = 4 };

struct Start {
    bool vp9 = false;        ///< false: JPEG
    bool jpegFirst = false;  ///< JPEG until the encoder of the video is ready
};
struct Received {
    uint32_t frame = 0;
};
struct Edit {
    nlohmann::json changes;
};
struct Open {
    std::string scene;
};
/// Asks for the values of the inspected image.
struct Read {
    std::array<float, 2> position{};  ///< from 0 to 1 in the picture
};
struct ClientMessage {
    uint64_t id = 0;  ///< chosen by the client
    std::variant<Start, Received, Edit, studio::Gesture, studio::Request, Open, Read> content;
};

/// Throws UsageError, with a text for the client, where the message is not one of the protocol.
ClientMessage parseMessage(std::string_view text);

/// The description of the state's fields for clients. `scenes`: those that may be opened; `uploads`: bytes of
/// the largest file that may be uploaded, 0: none.
nlohmann::json helloMessage(const std::vector<std::string>& scenes, uint64_t uploads);

struct FrameHeader {
    Codec codec = Codec::Jpeg;
    bool key = true, compared = false, lossless = false;
    bool inspected = false;  ///< the image of a pass, not the picture
    uint16_t width = 0, height = 0;
    uint32_t frame = 0;
    uint64_t message = 0, snapshot = 0;
    bool operator==(const FrameHeader&) const = default;
};
inline constexpr size_t frameHeaderBytes = 32;

std::array<std::byte, frameHeaderBytes> packed(const FrameHeader& header);
/// Throws Error if these are not the bytes of a header.
FrameHeader unpackedHeader(std::span<const std::byte> bytes);

}  // namespace limpid::serve
