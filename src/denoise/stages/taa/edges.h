// Smooths the edges of surfaces in one picture, by their shape: stairs of pixels become slanted lines. A.
// Reshetov, "Morphological Antialiasing", HPG 2009; edges are found by distances and normals, so neither
// noise nor textures count as edges. The formulas are in docs/denoising.md.
#pragma once

#include "denoise/api/denoiser_input.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// Passes "edges/find" and "edges/smooth". Neither `beauty` nor the result, of the same size, is negative.
/// The result is rgba16f on GPUs (filters in buffers), where `beauty` is at most 65504, else rgba32f.
/// `reach`: pixels along an edge in each direction, at least 1.
gpu::ImageHandle smoothEdges(gpu::FrameGraph& graph, const DenoiserInput& input, gpu::ImageHandle beauty,
                             uint32_t reach);

}  // namespace limpid::denoise
