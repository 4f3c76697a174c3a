// What a file of sums says about itself: all that decides the pixels, and where the render stands.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "renderer/long/block_plan.h"

namespace limpid {

/// A part of a render: the frames of a sequence, or the blocks of a still, whose number modulo `count` is
/// index - 1.
struct Shard {
    uint32_t index = 1;  ///< 1 to count
    uint32_t count = 1;

    bool has(uint64_t number) const { return number % count == index - 1; }
    /// How many of the numbers below `total` it has, and which the k-th is.
    uint64_t countOf(uint64_t total) const { return (total + count - index) / count; }
    uint64_t at(uint64_t k) const { return k * count + index - 1; }
    bool operator==(const Shard&) const = default;
};

struct AccumulationHeader {
    /// Name and value of everything that decides the pixels and has no member below, in the order in which a
    /// difference is reported (renderer/long/render_identity.h).
    std::vector<std::pair<std::string, std::string>> identity;
    gpu::Extent extent;
    BlockPlan plan;
    std::vector<std::string> layers;  ///< of layerNames(), in that order; empty: beauty alone
    uint64_t frames = 1;              ///< of the sequence; 1: a still
    Shard shard;

    uint64_t frame = 0;  ///< whose sums these are; one of the shard's
    /// Frames of this shard whose pictures are written, counted within the shard, first to last, ascending.
    std::vector<std::pair<uint64_t, uint64_t>> finished;

    /// What rendered it, for messages: samples of two devices, or of two tracers, are equally right, but
    /// differ in the last bits.
    std::string device, driver, tracer;

    // How the picture is to be written.
    bool floatColors = false;
    std::string exposure = "auto";

    /// The value of an entry of `identity`; empty if there is none.
    std::string_view value(std::string_view name) const;
};

/// What makes two renders different ones, for a message: "seed is 1, not 0" (`theirs`, not `ours`). Empty if
/// the samples of both may be mixed. Shard, frame, device and tracer are not compared.
std::optional<std::string> firstDifference(const AccumulationHeader& theirs, const AccumulationHeader& ours);

/// Logs a warning if the file's samples come from another device, driver or tracer.
void warnOfOtherDevice(const std::filesystem::path& file, const AccumulationHeader& theirs,
                       const AccumulationHeader& ours);

/// Of all that two runs must share for their pictures to be of one render: identity, size, plan, layers,
/// frames and how pictures are written.
uint64_t renderHash(const AccumulationHeader& header);

/// JSON. More than 4096 ranges of finished frames are cut off: what is forgotten is rendered again.
std::string toJson(const AccumulationHeader& header);

/// Throws InputError(file) if the text is no such header, or a value is outside its range.
AccumulationHeader headerFromJson(std::string_view text, const std::filesystem::path& file);

}  // namespace limpid
