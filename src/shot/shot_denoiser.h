// Denoises the frames of a shot, one after another, forwards or backwards.
#pragma once

#include <memory>
#include <vector>

#include "denoise/api/denoiser.h"
#include "gpu/vulkan/device.h"
#include "shot/frame/clean_picture.h"
#include "shot/frame/loaded_frame.h"

namespace limpid::shot {

/// Whether what a filter took away besides noise comes back; recover/recovery.h. Auto: by SVGF, nano and
/// film, in files whose pixels have independent noise.
enum class Recover { Auto, On, Off };

/// How the pictures are denoised.
struct ShotOptions {
    const denoise::Denoiser* method = nullptr;
    denoise::DenoiserSettings settings;
    denoise::DenoiserNetworks networks;
    std::shared_ptr<const CameraTrack> cameras;  ///< null: none are given
    /// Anti-aliases as `settings` say; else as the frames' samples need it, coverage of transparent film
    /// included.
    bool keepsAntialiasing = false;
    Recover recover = Recover::Auto;
};

enum class Direction { Forwards, Backwards };

/// Keeps the history of each picture. Frames come in ascending order, or in descending order if they are
/// denoised backwards. Then a frame's history is what follows it: the motion of the next frame, inverted.
class ShotDenoiser {
  public:
    ShotDenoiser(gpu::Device& device, const ShotOptions& options, Direction direction);
    ~ShotDenoiser();

    /// Denoises each picture. `continues`: the last call was for the neighbouring frame, and there is no cut
    /// between them. The frame's layers are freed.
    std::vector<CleanPicture> denoise(LoadedFrame& frame, bool continues);

    /// The graph of a picture, for times and dumps of its last frame.
    gpu::FrameGraph& graph(size_t picture);

  private:
    struct Picture;
    denoise::HostFrame hostFrame(LoadedFrame& frame, size_t index, Picture& picture, bool continues);
    static void goBackwards(denoise::HostFrame& host, Picture& picture, bool continues, bool own,
                            bool searched);
    void cleanGroups(Picture& picture, const LoadedFrame& file, size_t index, denoise::HostFrame& one,
                     bool continues, CleanPicture& result);
    CleanPicture clean(gpu::FrameGraph& graph, const denoise::HostFrame& frame, float framesOfEdges,
                       bool continues);
    std::vector<float> smoothed(gpu::FrameGraph& graph, const denoise::HostFrame& frame,
                                std::vector<float> colors, float frames, bool continues);
    bool recovers(const LoadedFrame& frame, size_t index) const;
    void coverFilm(Picture& picture, const LoadedFrame& file, size_t index, const denoise::HostFrame& frame,
                   bool continues, CleanPicture& result);

    gpu::Device& device_;
    const ShotOptions& options_;
    Direction direction_;
    std::vector<std::unique_ptr<Picture>> pictures_;
};

/// Inverts motion: where the next frame shows a pixel's surface, from the pixels of the next frame whose
/// motion leads to it (the nearest surface if there are several). Reflections are not followed.
void turnAround(denoise::HostFrame& now, const denoise::HostFrame& next);

}  // namespace limpid::shot
