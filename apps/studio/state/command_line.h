// The `limpid render` that makes the frame in the window again on the same device: to the last bit, but for
// the rounding of means with motion blur.
#pragma once

#include <string>

#include "renderer/method/settings.h"
#include "renderer/sequence/shutter.h"
#include "scene/load/scene_source.h"
#include "studio/live/playback.h"

namespace limpid::studio {

/// What decides the frame in the window.
struct ShownFrame {
    scene::SceneSource source;
    std::string device;   ///< as it was asked for (gpu::DeviceOptions::select); empty: the best one
    std::string clip;     ///< name; empty: the scene moves by none
    std::string weights;  ///< of networks; empty: those that come along
    RenderSettings settings;
    uint32_t samples = 1;        ///< per pixel and frame
    uint64_t samplesInMean = 0;  ///< without a denoiser
    std::string camera;          ///< its options, as "--camera 2"; empty: as `playback` has it
    float fovDegrees = 45.0f;
    Shutter shutter;  ///< closed: no motion blur
};

struct CommandLine {
    std::string text;
    bool needsPath = false;  ///< "--camera-path" in it names a file that pathText() must be written to
    std::string problem;     ///< if not empty, the frame cannot be made again, and this says why
};

/// Of the last frame. `pathFile` is named where the camera moved.
CommandLine commandLineOf(const ShownFrame& frame, const Playback& playback, const std::string& pathFile);

/// The `limpid view` or `limpid serve` that shows the same scene with the state in a file (state_file.h).
std::string stateCommandOf(const ShownFrame& frame, const std::string& command, const std::string& stateFile);

/// The command of a shell that writes a line of text to a file.
std::string writingCommandOf(const std::string& text, const std::string& file);

/// The camera since the reset as a file for --camera-path (docs/animation.md).
std::string pathText(const Playback& playback, float fovDegrees);

/// As one word of a shell.
std::string quoted(const std::string& word);

}  // namespace limpid::studio
