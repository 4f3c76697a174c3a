// Merges the shards of a sequence.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "base/files/frame_pattern.h"
#include "renderer/long/sums/accumulation_header.h"

namespace limpid {

/// String attributes of a frame's EXR file that identify its render: the render's hash, the frame's number
/// and the number of frames. Empty for a still.
std::map<std::string, std::string> frameMetadata(const AccumulationHeader& header, uint64_t frame);

/// Copies the frames of all inputs (EXR files with frameMetadata()) to `output`, byte for byte; returns
/// their number. Checks all frames before it writes any. Throws InputError with the file and the reason if an
/// input has no frames, or a frame cannot be read, does not identify its render, belongs to another render
/// than the first, contains another number than its name, or is also in an earlier input. Also throws if
/// frames are missing, naming them.
int mergeFrames(std::span<const FramePattern> inputs, const FramePattern& output);

}  // namespace limpid
