// Reads the files of a shot's frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/files/frame_pattern.h"
#include "base/layers/layer_table.h"
#include "denoise/api/host_frame.h"
#include "shot/frame/shot_frame.h"

namespace limpid::shot {

/// A file, and what was understood of it.
struct LoadedFrame {
    int number = 0;
    uint64_t content = 0;  ///< a hash of the frame's files
    image::ExrDocument file;
    std::vector<LayerMap> maps;      ///< of each picture
    std::vector<ShotLayers> layers;  ///< of each picture, once unpacked; empty if `own` is used
    /// Files with all of Limpid's layers are read as docs/layers.md says: with turns, reflections and
    /// variances.
    std::optional<denoise::HostFrame> own;
    std::vector<const LayerInfo*> lacking;  ///< of `own`: advised layers that are missing
    /// What the user should know of the file, beside layers that are missing: once, not for each frame.
    std::vector<std::string> warnings;
    /// For networks: the layers whose variances are estimated, as the file has none that are used.
    std::vector<const LayerInfo*> estimated;
};

struct LoadOptions {
    Assignments assignments;
    bool network = false;      ///< the denoiser reads variances of all layers, and no motion
    bool variances = false;    ///< the denoiser reads those of light, if the file has them
    bool sequence = false;     ///< layers of a sequence are needed
    bool searchMotion = true;  ///< in sequences whose files have no motion
    bool layersOnly = false;   ///< Limpid's own files are read as `layers`, too
    /// Files beside the frame's: all their channels are like those of a part of this name. If it is a role's,
    /// they win over the frame's own layers.
    std::vector<std::pair<std::string, FramePattern>> files;
};

/// Reads a file, and decodes it unless it takes much memory: EXR, or a picture in PFM, Radiance HDR, PNG or
/// JPEG, which has a beauty alone. Of attached files, only the parts that are used are decoded. Throws
/// InputError, and UsageError if an attached file is not used, or its format cannot hold the values of its
/// role.
LoadedFrame loadFrame(const std::filesystem::path& path, int number, const LoadOptions& options);

/// The hash LoadedFrame::content, without decoding. Throws InputError if a file cannot be read.
uint64_t contentOf(const std::filesystem::path& path, int number, const LoadOptions& options);

/// Makes `layers` or `own` of the file, decoding it if loadFrame() did not; they take more memory than it.
/// Throws InputError.
void unpack(LoadedFrame& frame, const LoadOptions& options);

}  // namespace limpid::shot
