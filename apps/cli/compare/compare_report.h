// The results of `limpid compare`, as JSON and as tables.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "image/metrics/frame_scores.h"
#include "image/metrics/metrics.h"

namespace limpid::cli {

/// One object on one line. JSON has no infinity: the PSNR of equal pictures is null.
std::string pictureJson(const image::Comparison& scores, const std::optional<image::HdrFlip>& hdr);
std::string pictureTable(const image::Comparison& scores, const std::optional<image::HdrFlip>& hdr);

/// What holds for all frames of a sequence.
struct SequenceFacts {
    uint32_t width = 0, height = 0;
    float exposure = 0.0f;  ///< stops
};

std::string sequenceJson(std::span<const image::FrameScores> frames, const SequenceFacts& facts);
std::string sequenceTable(std::span<const image::FrameScores> frames, const SequenceFacts& facts);

}  // namespace limpid::cli
