// Variances of frames whose files have none.
#pragma once

#include <span>

#include "base/layers/layer_table.h"
#include "denoise/api/host_frame.h"

namespace limpid::shot {

/// Gives the layers the variances that networks read (the fourth float of each texel, times samples - 1; see
/// DenoiserInput::samples), of the means that the pixels hold.
///
/// Those of diffuse and specular light are estimated from the pixels around: light without its albedo minus
/// the mean of the eight neighbours is noise, whose square is averaged over 7x7 pixels, without fireflies.
/// Neighbours count as far as their normal, distance and object are alike. Neighbours on opposite sides count
/// alike, too, so that gradients of light are no noise. Those of the guides become 0, as with rays through
/// the pixels' centres.
///
/// Without specular light there is one signal: zeros are added for what networks see of the other one. A
/// frame of one sample counts as one of two: variances of one sample are not defined (HostFrame::samples).
///
/// `layers`: only those with LayerInfo::varianceInFiles.
void estimateVariances(denoise::HostFrame& frame, std::span<const LayerInfo* const> layers);

}  // namespace limpid::shot
