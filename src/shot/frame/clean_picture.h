// A denoised picture, and its way back into the file.
#pragma once

#include <set>
#include <vector>

#include "denoise/methods/temporal/temporal.h"
#include "image/io/exr/exr_document.h"
#include "shot/frame/shot_frame.h"
#include "shot/layers/layer_map.h"

namespace limpid::shot {

/// One clean picture of a frame.
struct CleanPicture {
    std::vector<float> beauty;  ///< RGBA per pixel
    std::vector<float> alpha;   ///< on transparent film: coverage without noise, per pixel; empty if it stays
    std::vector<float> frames;  ///< of each pixel's history; empty without temporal accumulation
    /// Clean light groups, RGBA per pixel, and what no group has; see shareOut(). Empty if there are none.
    std::vector<std::vector<float>> groups;
    FrameReport report;
    denoise::DisocclusionCounts disocclusion;
};

/// The mean of what was denoised forwards and backwards, each weighted by the frames of its history. Without
/// histories, forwards.
void merge(CleanPicture& forwards, const CleanPicture& backwards);

/// Whether it is a single layer of the file.
bool isReplaceable(const image::ExrDocument& file, const LayerExpression& expression);
/// Throws UsageError if the beauty or a light group is no single layer of the file, so that it cannot be
/// replaced.
void checkReplaceable(const image::ExrDocument& file, const LayerMap& map);

/// Scales the groups so that their sum is the beauty at each pixel and component; where all are 0, the last
/// one (what no group has) gets it.
void shareOut(CleanPicture& picture);

/// Puts a clean picture in the place of its beauty, and its groups in the place of theirs, and returns the
/// parts that changed. The map has passed checkReplaceable().
std::set<size_t> replacePicture(image::ExrDocument& file, const LayerMap& map, const CleanPicture& picture);

}  // namespace limpid::shot
