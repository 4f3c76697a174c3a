// The header of a file of sums: everything that determines the pixels, and the progress of the render.
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

/// A part of a render: those frames of a sequence, or blocks of a still, whose number modulo `count` is index
/// - 1.
struct Shard {
    uint32_t index = 1;  ///< 1 to count
    uint32_t count = 1;

    bool has(uint64_t number) const { return number % count == index - 1; }
    /// How many of the numbers below `total` belong to the shard, and which one is the k-th.
    uint64_t countOf(uint64_t total) const { return (total + count - index) / count; }
    uint64_t at(uint64_t k) const { return k * count + index - 1; }
    bool operator==(const Shard&) const = default;
};

struct AccumulationHeader {
    /// Name and value of everything that determines the pixels and has no member below, in the order in which
    /// differences are reported (renderer/long/render_identity.h).
    std::vector<std::pair<std::string, std::string>> identity;
    gpu::Extent extent;
    BlockPlan plan;
    std::vector<std::string> layers;  ///< a subset of layerNames(), in that order; empty: beauty only
    uint64_t frames = 1;              ///< length of the sequence; 1: a still
    Shard shard;

    uint64_t frame = 0;  ///< frame of the shard that the sums belong to
    /// Frames of this shard whose pictures are written, counted within the shard, first to last, ascending.
    std::vector<std::pair<uint64_t, uint64_t>> finished;

    /// For messages. Samples of two devices or two tracers are equally correct, but differ in the last bits.
    std::string device, driver, tracer;

    // How the picture is to be written.
    bool floatColors = false;
    std::string exposure = "auto", toneCurve = "standard";

    /// The value of an entry of `identity`; empty if there is none.
    std::string_view value(std::string_view name) const;
};

/// The first difference between two renders, for a message: "seed is 1, not 0" (`theirs`, not `ours`). Empty
/// if the samples of both may be mixed. Shard, frame, device and tracer are not compared.
std::optional<std::string> firstDifference(const AccumulationHeader& theirs, const AccumulationHeader& ours);

/// The first difference in how pictures are written, in the same words.
std::optional<std::string> firstDifferenceOfLook(const AccumulationHeader& theirs,
                                                 const AccumulationHeader& ours);

/// Logs a warning if the file's samples come from another device, driver or tracer.
void warnOfOtherDevice(const std::filesystem::path& file, const AccumulationHeader& theirs,
                       const AccumulationHeader& ours);

/// Hash of everything that two runs of one render have in common: identity, size, plan, layers, frames and
/// how pictures are written.
uint64_t renderHash(const AccumulationHeader& header);

/// JSON. At most 4096 ranges of finished frames are kept; frames in other ranges are rendered again.
std::string toJson(const AccumulationHeader& header);

/// Throws InputError(file) if the text is not such a header, or a value is outside its range.
AccumulationHeader headerFromJson(std::string_view text, const std::filesystem::path& file);

}  // namespace limpid
