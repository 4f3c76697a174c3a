// A pipeline: an integrator that computes a frame, and optionally a denoiser that cleans it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "denoise/api/denoiser.h"

namespace limpid {

/// The integrators of --integrator.
enum class Integrator {
    Path,              ///< all light, by path tracing
    Direct,            ///< the path tracer with paths of one bounce
    AmbientOcclusion,  ///< the unoccluded share at each first hit
    GBuffer,           ///< the first hit, lit by one light sample
    Preview,           ///< the first hit, shaded without the scene's lights
};

/// All integrators, in the order in which `limpid info` lists them.
const std::vector<Integrator>& integrators();
std::string_view nameOf(Integrator integrator);
std::string_view helpOf(Integrator integrator);
/// True if the integrator writes all layers that denoisers read.
bool canBeDenoised(Integrator integrator);
/// True if this denoiser can be used with the integrator. That of one channel is for ambient occlusion alone.
bool canBeDenoised(Integrator integrator, const denoise::Denoiser& denoiser);
/// An integrator for which the denoiser can be used: `wanted`, if possible.
Integrator integratorFor(const denoise::Denoiser& denoiser, Integrator wanted);
/// Throws UsageError with the list of names if the name is unknown.
Integrator parseIntegrator(std::string_view name);

/// Returns "none" for null.
std::string_view nameOf(const denoise::Denoiser* denoiser);
/// Returns "none" and the denoisers' names.
std::vector<std::string_view> denoiserNames();
/// Returns null for "none". Throws UsageError with the list of names if the name is unknown.
const denoise::Denoiser* parseDenoiser(std::string_view name);

/// The path tracer alone by default.
struct Pipeline {
    Integrator integrator = Integrator::Path;
    const denoise::Denoiser* denoiser = nullptr;  ///< null: none

    /// Returns the command-line options: "--integrator ao --denoiser svgf".
    std::string options() const;
    /// Returns a short form for titles: "ao", "ao, svgf".
    std::string title() const;
    /// True if the picture is the mean of all samples since the last change. Otherwise each frame has its own
    /// samples, and the denoiser keeps histories.
    bool accumulates() const { return !denoiser; }
    /// True if its denoiser is a neural network, which needs weights and frames of several samples.
    bool usesNetwork() const { return denoiser && denoiser->network; }
    /// True if the integrator's passes trace one primary ray per pixel and launch.
    bool takesOneSampleALaunch() const {
        return integrator != Integrator::Path && integrator != Integrator::Direct;
    }
    /// True if its picture is radiance. Otherwise it has values from 0 to 1, which are shown without
    /// exposure.
    bool needsExposure() const {
        return integrator != Integrator::AmbientOcclusion && integrator != Integrator::Preview;
    }
    /// The subset of layerNames(), in that order, that an EXR file of this pipeline can have.
    std::vector<std::string> layers() const;
    bool operator==(const Pipeline&) const = default;
};

/// Every integrator alone, and combined with each denoiser that supports it.
const std::vector<Pipeline>& pipelines();
/// Throws UsageError if there is no such integrator or denoiser, or if they cannot be combined.
Pipeline parsePipeline(std::string_view integrator, std::string_view denoiser = "none");

}  // namespace limpid
