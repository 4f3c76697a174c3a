// What a user asks for, in the words of the command line, and the job that it makes.
#pragma once

#include <string>
#include <vector>

#include "shot/run/shot_job.h"

namespace limpid::shot {

/// The options of `limpid denoise`; "" and empty lists are their defaults. docs/denoise-your-renders.md
/// describes them.
struct ShotRequest {
    std::string input;   ///< a file, or "shot.%04d.exr"
    std::string output;  ///< "": only for explainShot()
    std::string denoiser, preset, weights;
    std::vector<std::string> settings;  ///< "svgf.alpha=0.1"
    std::vector<std::string> map;       ///< "albedo=MyAlbedo.RGB"
    std::string mapFile;
    std::vector<std::string> files;  ///< "albedo=albedo.%04d.pfm"
    std::string cameras;             ///< a JSON or glTF file
    GltfTiming cameraTiming;
    std::string motion = "auto";   ///< or "none": where files have no motion
    std::string frames;            ///< "10-20" or "7"
    std::string shard;             ///< "2/4"
    std::string cuts = "auto";     ///< "none", or "12,40"
    std::string onError = "stop";  ///< or "skip"
    std::string exposure = "auto";
    float strength = 1.0f, preserve = 0.0f;
    std::string recover = "auto";  ///< or "on", "off"
    bool bidirectional = false, resume = false;
};

/// Reads the files of cameras and of the map, and finds the frames; messages, progress and networks are left
/// to the caller. Throws UsageError and InputError.
ShotJob jobOf(const ShotRequest& request);

}  // namespace limpid::shot
