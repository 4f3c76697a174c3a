// The inputs of every denoiser.
#pragma once

#include "base/layers/layer_set.h"
#include "denoise/api/host_frame.h"
#include "denoise/stages/motion_encoding.h"
#include "denoise/stages/normal_encoding.h"
#include "gpu/graph/frame_graph.h"
#include "shaders/common/camera.h"

namespace limpid::denoise {

class NanoHost;

/// For debugging: whether methods with histories also tell why they kept or rejected those of each pixel, in
/// DenoiserOutput::reasons.
struct ReasonsRequest {
    bool wanted = false;
    bool cut = false;  ///< no pixel has motion, because the frame continues none
};

/// One frame: an image for each layer of base/layers/layer_table.h, all of one size. Filters sample them, so
/// they may have any float format, and albedos may have one pixel that counts for all; networks need rgba32f.
/// `ids` has unsigned components: instance and material, UINT32_MAX where the ray misses. docs/denoising.md,
/// "What a frame gives", describes the components. Filters that find specular, albedoSpecular, emission,
/// previousNormal, reflectionMotion or ids empty do without. Rays go through the same point of all pixels.
/// NaN and infinity are allowed: such radiance is rejected; such a distance, motion or normal counts as
/// missing (SVGF replaces such a normal by +Z).
struct DenoiserInput : LayerSet<gpu::ImageHandle> {
    CameraParams camera{};
    /// Samples per pixel in the means. Alpha of diffuse, specular, albedo, normal and depth is the mean
    /// squared deviation over these samples: of the luminance, for normals the mean of the components, for
    /// depth its own. kpcn needs it.
    uint32_t samples = 1;
    /// Alpha of diffuse and specular is set, for methods with Denoiser::readsVariances.
    bool variances = false;
    /// From the pixels' centres to the point that this frame's rays go through, pixels, y down; the mean over
    /// samples. 0 also where it is unknown.
    vec2 jitter{0.0f};
    /// The jitter changes from frame to frame, to smooth edges: TaaSettings::frames is 2 by default.
    bool jitterChanges = false;
    gpu::Backing filters = gpu::Backing::Image;  ///< these four: choose()
    bool matrices = false;
    uint64_t largestBuffer = UINT64_MAX;  ///< bytes
    bool cpu = false;
    /// Computes `nano` and `film` on the CPU; null: shaders do. It must outlive execute().
    NanoHost* host = nullptr;
    /// Made by the ingest pass, or empty: what the surfaces stage makes of a frame's layers. With them,
    /// methods whose `readsLayers` is false find normal, depth and ids empty.
    gpu::History surfaces;
    NormalEncoding normalEncoding{};  ///< of previousNormal
    MotionEncoding motionEncoding{};  ///< of motion and reflectionMotion; anti-aliasing takes layers only
    /// Where a method that ends with the compose stage writes its picture (ComposeInput::target), unless it
    /// is anti-aliased afterwards.
    gpu::ImageHandle target;
    ReasonsRequest reasons;
    bool wantsSignals = false;  ///< DenoiserOutput::diffuse and specular, too

    /// `choice`: from gpu::filterChoice(device).
    void choose(const gpu::FilterChoice& choice) {
        filters = choice.backing;
        matrices = choice.matrices;
        largestBuffer = choice.largestBuffer;
        cpu = choice.cpu;
    }
};

/// Uploads the frame's images; optional layers that are empty become zeros, but roughness, hit distance, and
/// specular light with its albedo stay empty. Throws Error if an image of `frame` has another size than the
/// frame.
DenoiserInput upload(gpu::FrameGraph& graph, const HostFrame& frame);

/// The same by FrameGraph::uploadBorrowed(): `frame` must stay as it is until the graph has been executed.
DenoiserInput uploadBorrowed(gpu::FrameGraph& graph, const HostFrame& frame);
DenoiserInput uploadBorrowed(gpu::FrameGraph& graph, HostFrame&& frame) = delete;

}  // namespace limpid::denoise
