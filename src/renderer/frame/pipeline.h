// What a frame is made by, as --pipeline names it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "denoise/api/denoiser.h"

namespace limpid {

/// `path` by default.
struct Pipeline {
    enum class Kind {
        Path,              ///< the path tracer alone, accumulated
        GBuffer,           ///< what the camera sees, lit directly, accumulated
        AmbientOcclusion,  ///< how open each visible point is, accumulated
        Preview,           ///< what the camera sees, shaded without the scene's light, accumulated
        Denoised,          ///< the path tracer and a denoiser
    };
    Kind kind = Kind::Path;
    const denoise::Denoiser* denoiser = nullptr;  ///< of Denoised

    std::string_view name() const;
    std::string_view help() const;
    /// Each frame is a mean of its own, or of all frames since the camera stood still.
    bool accumulates() const { return kind != Kind::Denoised; }
    /// Its passes trace one primary ray per pixel and launch.
    bool takesOneSampleALaunch() const { return kind != Kind::Path && kind != Kind::Denoised; }
    /// Its picture is radiance; otherwise values from 0 to 1, which are shown without exposure.
    bool needsExposure() const { return kind != Kind::AmbientOcclusion && kind != Kind::Preview; }
    /// Of layerNames(), in that order: those that an EXR file can have.
    std::vector<std::string> layers() const;
    bool operator==(const Pipeline&) const = default;
};

/// All, in the order in which `limpid info` lists them.
const std::vector<Pipeline>& pipelines();
/// Throws UsageError listing the names if there is none of this one.
Pipeline parsePipeline(std::string_view name);

}  // namespace limpid
