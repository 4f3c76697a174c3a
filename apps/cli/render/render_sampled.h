// `limpid render` of independent frames: what one process and several that share the work have in common.
#pragma once

#include "cli/render/render_job.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/long/sums/accumulation.h"

namespace limpid::cli {

/// The header that describes this render in files of sums and pictures.
AccumulationHeader headerOf(const RenderJob& job);

/// Writes the output of a frame, from its sums, and what --dump names.
void writeSampled(const RenderJob& job, const AccumulationHeader& header, uint64_t frame,
                  const FrameSums& sums, FrameRenderer& renderer);

/// As renderIndependentFrames(), by the processes of a cluster: of a still, each renders blocks of samples,
/// and process 0 adds them and writes; of a sequence, each renders frames and writes their files.
void renderSharedFrames(const RenderJob& job, RenderSummary& summary);

}  // namespace limpid::cli
