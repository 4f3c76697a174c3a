// What a frame is made by: an integrator, and a denoiser that cleans what it gives.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "denoise/api/denoiser.h"

namespace limpid {

/// What is computed, as --integrator names it.
enum class Integrator {
    Path,              ///< all light, by path tracing
    Direct,            ///< the path tracer with paths of one bounce
    AmbientOcclusion,  ///< how open each visible point is
    GBuffer,           ///< what the camera sees, lit by one light sample
    Preview,           ///< what the camera sees, shaded without the scene's light
};

/// All, in the order in which `limpid info` lists them.
const std::vector<Integrator>& integrators();
std::string_view nameOf(Integrator integrator);
std::string_view helpOf(Integrator integrator);
/// It gives all that denoisers read.
bool canBeDenoised(Integrator integrator);
/// Throws UsageError listing the names if there is none of this one.
Integrator parseIntegrator(std::string_view name);

/// "none" for null.
std::string_view nameOf(const denoise::Denoiser* denoiser);
/// "none" and the denoisers.
std::vector<std::string_view> denoiserNames();
/// Null for "none". Throws UsageError listing the names if there is none of this one.
const denoise::Denoiser* parseDenoiser(std::string_view name);

/// The path tracer alone by default.
struct Pipeline {
    Integrator integrator = Integrator::Path;
    const denoise::Denoiser* denoiser = nullptr;  ///< null: none

    /// As on the command line: "--integrator ao --denoiser svgf".
    std::string options() const;
    /// For titles: "ao", "ao, svgf".
    std::string title() const;
    /// The picture is the mean of all samples since anything changed. Otherwise each frame has its own
    /// samples, and the denoiser keeps histories.
    bool accumulates() const { return !denoiser; }
    /// Its denoiser is a neural network, which needs weights and frames of several samples.
    bool usesNetwork() const { return denoiser && denoiser->network; }
    /// The integrator's passes trace one primary ray per pixel and launch.
    bool takesOneSampleALaunch() const {
        return integrator != Integrator::Path && integrator != Integrator::Direct;
    }
    /// Its picture is radiance; otherwise values from 0 to 1, which are shown without exposure.
    bool needsExposure() const {
        return integrator != Integrator::AmbientOcclusion && integrator != Integrator::Preview;
    }
    /// Of layerNames(), in that order: those that an EXR file can have.
    std::vector<std::string> layers() const;
    bool operator==(const Pipeline&) const = default;
};

/// Every integrator alone and with each denoiser that can clean it.
const std::vector<Pipeline>& pipelines();
/// Throws UsageError if there is no such integrator or denoiser, or if this integrator cannot be denoised.
Pipeline parsePipeline(std::string_view integrator, std::string_view denoiser = "none");

}  // namespace limpid
