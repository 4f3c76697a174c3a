// A shot to denoise: which frames, how, and where the results go.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/files/frame_pattern.h"
#include "base/message.h"
#include "shot/shot_denoiser.h"

namespace limpid::shot {

enum class Cuts { Found, Given };

struct ShotJob {
    FramePattern input, output;
    std::vector<int> frames;  ///< ascending; -1 for a single file
    /// Indices of the frames that the user asks for. Those around them only make histories, so the run goes
    /// on if they cannot be read.
    size_t firstAsked = 0, endAsked = 0;
    /// Indices of the frames that are written: those asked for, or a part of them.
    size_t firstWritten = 0, endWritten = 0;
    /// What the result depends on besides the input, for the attribute "limpid.input" of EXR files.
    std::string settingsText;
    bool resume = false;  ///< begin at the first frame whose output is not that of its input and the settings
    LoadOptions load;
    ShotOptions options;
    std::vector<std::string> warnings;  ///< to say when the run begins
    std::string weights;                ///< of a network; empty: those that come with Limpid
    bool bidirectional = false;
    float strength = 1.0f;  ///< share of the clean picture in the result
    float preserve = 0.0f;  ///< share of filtered detail that is given back; keep_input.h
    Cuts cuts = Cuts::Found;
    std::vector<int> cutFrames;  ///< if given: the first frame after each cut
    bool skipUnreadable = false;
    std::optional<float> exposure;  ///< of PNG files, stops; none: measured

    MessageCallback messages;
    /// Called for each frame that is denoised; false stops the run, and frames so far are written. `done` of
    /// `total` frames are finished: in run-ups and backward runs it stays the same.
    std::function<bool(size_t done, size_t total)> progress;
    /// Called after each frame that is written, with the graph of its first picture.
    std::function<void(int frame, gpu::FrameGraph& graph)> afterFrame;
};

/// How many frames before its first one a part of a shot needs, so that histories are nearly as long as they
/// get.
inline constexpr size_t runUpFrames = 16;

/// Frames of a block of bidirectional shots. (Its backward run starts runUpFrames behind its end.)
inline constexpr size_t blockFrames = 32;

inline std::filesystem::path inputOf(const ShotJob& job, int frame) {
    return job.input.format(std::max(frame, 0));
}
inline std::filesystem::path outputOf(const ShotJob& job, int frame) {
    return job.output.format(std::max(frame, 0));
}
inline void warn(const ShotJob& job, const std::string& text) {
    if (job.messages) job.messages(MessageLevel::Warning, text);
}

}  // namespace limpid::shot
