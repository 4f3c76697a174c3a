// Reads, denoises and writes the frames of a shot: the next frame is read and the last one written while one
// is denoised.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/files/frame_pattern.h"
#include "shot/shot_denoiser.h"

namespace limpid::cli {

enum class Cuts { Found, Given };

struct ShotJob {
    FramePattern input, output;
    std::vector<int> frames;  ///< ascending; -1 for a single file
    /// Indices of the frames that are written; those around them only make histories.
    size_t firstWritten = 0, endWritten = 0;
    /// What the result depends on besides the input, for the attribute "limpid.input" of EXR files.
    std::string settingsText;
    bool resume = false;  ///< begin at the first frame whose output is not that of its input and the settings
    shot::LoadOptions load;
    shot::ShotOptions options;
    bool bidirectional = false;
    float strength = 1.0f;  ///< share of the clean picture in the result
    Cuts cuts = Cuts::Found;
    std::vector<int> cutFrames;  ///< if given: the first frame after each cut
    bool skipUnreadable = false;
    std::string exposure;  ///< of PNG files
    std::string dump;      ///< a pass, or empty
};

/// How many frames before its first one a part of a shot needs, so that histories are nearly as long as they
/// get.
inline constexpr size_t runUpFrames = 16;

struct ShotSummary {
    int frames = 0;  ///< written
    int kept = 0;    ///< found complete
    double seconds = 0.0;
    std::vector<int> skipped, cuts;
    std::map<std::string, double> lastFrame;  ///< ms by pass
};

/// Throws InputError if a frame cannot be read and is not to be skipped; frames before it are complete.
/// Bidirectional shots are denoised in blocks, which bounds the memory: each block first backwards, beginning
/// some frames behind its end, then forwards.
ShotSummary denoiseShot(const ShotJob& job, gpu::Device& device);

}  // namespace limpid::cli
