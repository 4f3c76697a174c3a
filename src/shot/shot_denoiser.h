// Denoises the frames of a shot, one after another, forwards or backwards.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "base/files/frame_pattern.h"
#include "denoise/api/denoiser.h"
#include "denoise/methods/temporal/temporal.h"
#include "gpu/vulkan/device.h"
#include "shot/shot_frame.h"

namespace limpid::shot {

/// A file, and what was understood of it.
struct LoadedFrame {
    int number = 0;
    image::ExrDocument file;
    std::vector<LayerMap> maps;      ///< of each picture
    std::vector<ShotLayers> layers;  ///< of each picture, once unpacked; empty if `own` is used
    /// Files with all of Limpid's layers are read as docs/layers.md says: with turns, reflections and
    /// variances.
    std::optional<denoise::HostFrame> own;
    std::vector<const LayerInfo*> lacking;  ///< of `own`: advised layers that are missing
};

struct LoadOptions {
    Assignments assignments;
    bool network = false;     ///< the denoiser needs variances
    bool sequence = false;    ///< layers of a sequence are needed
    bool layersOnly = false;  ///< Limpid's own files are read as `layers`, too
    /// Files beside the frame's: their channels are like those of a part of this name.
    std::vector<std::pair<std::string, FramePattern>> files;
};

/// Reads and decodes a file: EXR, or a picture in PFM, Radiance HDR, PNG or JPEG, which has a beauty alone.
/// Throws InputError.
LoadedFrame loadFrame(const std::filesystem::path& path, int number, const LoadOptions& options);

/// Makes `layers` or `own` of the decoded file, which take more memory than it. Throws InputError, also if a
/// network lacks layers.
void unpack(LoadedFrame& frame, const LoadOptions& options);

/// How the pictures are denoised.
struct ShotOptions {
    const denoise::Denoiser* method = nullptr;
    denoise::DenoiserSettings settings;
    denoise::DenoiserNetworks networks;
    const CameraTrack* cameras = nullptr;  ///< null: none are given
    /// Anti-aliases as `settings` say; else as the frames' samples need it, coverage of transparent film
    /// included.
    bool keepsAntialiasing = false;
};

/// One clean picture of a frame.
struct CleanPicture {
    std::vector<float> beauty;  ///< RGBA per pixel
    std::vector<float> alpha;   ///< on transparent film: coverage without noise, per pixel; else empty
    std::vector<float> frames;  ///< of each pixel's history; empty without temporal accumulation
    /// Clean light groups, RGBA per pixel, and what no group has; see shareOut(). Empty if there are none.
    std::vector<std::vector<float>> groups;
    FrameReport report;
    denoise::DisocclusionCounts disocclusion;
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
    void cleanGroups(Picture& picture, const ShotLayers& layers, const denoise::HostFrame& frame,
                     bool continues, CleanPicture& result);
    CleanPicture clean(gpu::FrameGraph& graph, const denoise::HostFrame& frame, float framesOfEdges,
                       bool continues);
    std::vector<float> smoothed(gpu::FrameGraph& graph, const denoise::HostFrame& frame,
                                std::vector<float> colors, float frames, bool continues);
    void coverFilm(Picture& picture, const ShotLayers& layers, const denoise::HostFrame& frame,
                   bool continues, CleanPicture& result);

    gpu::Device& device_;
    const ShotOptions& options_;
    Direction direction_;
    std::vector<std::unique_ptr<Picture>> pictures_;
};

/// Inverts motion: where the next frame shows a pixel's surface, from the pixels of the next frame whose
/// motion leads to it (the nearest surface if there are several). Reflections are not followed.
void turnAround(denoise::HostFrame& now, const denoise::HostFrame& next);

/// The mean of what was denoised forwards and backwards, each weighted by the frames of its history. Without
/// histories, forwards.
void merge(CleanPicture& forwards, const CleanPicture& backwards);

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
