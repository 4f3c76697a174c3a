// Shards of a sequence put together.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "base/files/frame_pattern.h"
#include "renderer/long/accumulation_header.h"

namespace limpid {

/// What a frame's EXR file says about the render it is from, as string attributes: the render's hash, the
/// frame's number and how many there are. Empty for a still.
std::map<std::string, std::string> frameMetadata(const AccumulationHeader& header, uint64_t frame);

/// Copies the frames of all inputs (EXR files with frameMetadata()) to `output`, byte for byte; returns how
/// many there are. Nothing is written before all are checked. Throws InputError naming a file and the reason
/// if an input has no frames, or a frame cannot be read, says nothing of its render, is of another render
/// than the first, carries another number than its name, or is in an earlier input too; and if all together
/// lack frames, naming those.
int mergeFrames(std::span<const FramePattern> inputs, const FramePattern& output);

}  // namespace limpid
