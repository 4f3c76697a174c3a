#include "cli/options/lens_options.h"

#include "base/error.h"
#include "cli/console/help_text.h"

namespace limpid::cli {
namespace {

/// The layers are of the same rays as the light. Where out-of-focus points lie over each other, those of
/// single frames change at random, and there is no one motion: a history does not find what it had.
void checkPipeline(const Pipeline& pipeline) {
    if (pipeline.takesOneSampleALaunch())
        throw UsageError("a lens is for --integrator path and direct; " + pipeline.options() +
                         " has a pinhole");
    if (pipeline.denoiser && pipeline.denoiser->keepsHistory)
        throw UsageError(
            "a lens is not for " + pipeline.options() +
            ": it follows surfaces from frame to frame, which a pixel out of focus has several of; "
            "render without a denoiser, or use kpcn or bilateral");
}

}  // namespace

void addLensOptions(CLI::App& command, scene::Lens& lens) {
    const OptionGroup group(command, "Lens (depth of field)");
    command
        .add_option(
            "--f-stop", lens.fStop,
            "Aperture as f-number: focal length over diameter of the lens, as in 2.8; less blurs more "
            "of what is out of focus; needs scenes in metres")
        ->check(CLI::Range(1e-3, 1e6));
    command
        .add_option("--lens-diameter", lens.diameter,
                    "Aperture as diameter of the lens, metres (0: a pinhole, all is sharp)")
        ->check(CLI::Range(0.0, 1e9));
    command
        .add_option(
            "--focus-distance", lens.focusDistance,
            "Distance along the view to the plane in focus, metres (that of the target of --target, of a "
            "camera path or of a built-in camera)")
        ->check(CLI::Range(1e-9, 1e18));
    command
        .add_option("--focal-length", lens.focalLength,
                    "Focal length, mm: sets the field of view; less shows more (from the camera)")
        ->check(CLI::Range(1e-3, 1e6));
    command.add_option("--sensor-height", lens.sensorHeight, "Height of the sensor, mm (24)")
        ->check(CLI::Range(1e-3, 1e6));
}

void checkLens(const scene::Lens& lens, const Pipeline& pipeline) {
    if (lens.fStop > 0.0f && lens.diameter >= 0.0f)
        throw UsageError("--f-stop and --lens-diameter say the same: give one of them");
    if (lens.sensorHeight != scene::Lens{}.sensorHeight && lens.fStop == 0.0f && lens.focalLength == 0.0f)
        throw UsageError("--sensor-height goes with --f-stop or --focal-length");
    if (lens.fStop > 0.0f || lens.diameter > 0.0f) checkPipeline(pipeline);
}

void checkLensOf(const scene::Camera& camera, const scene::Lens& lens, const Pipeline& pipeline) {
    const bool given =
        lens.fStop > 0.0f || lens.diameter > 0.0f || lens.focusDistance > 0.0f || lens.focalLength > 0.0f;
    if (camera.orthographic && given)
        throw UsageError(
            "--f-stop, --lens-diameter, --focus-distance and --focal-length: the camera is orthographic");
    if (camera.lensDiameter == 0.0f && lens.focusDistance > 0.0f)
        throw UsageError("--focus-distance goes with --f-stop or --lens-diameter");
    if (camera.lensDiameter == 0.0f) return;
    checkPipeline(pipeline);
    if (camera.focusDistance == 0.0f)
        throw UsageError("a lens needs --focus-distance, or --eye and --target");
}

}  // namespace limpid::cli
