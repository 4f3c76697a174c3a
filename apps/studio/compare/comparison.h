// What the picture is compared with: another integrator or denoiser on the same frames, or a reference that
// converges.
#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include "studio/live/live_render.h"
#include "studio/state/timings.h"

namespace limpid::studio {

/// The choices: nothing, each integrator alone, each denoiser on what is shown, the reference, and settings
/// that were kept, of the same denoiser or another.
std::vector<std::string> comparisonNames();

struct ComparisonChoice {
    int with = 0;                 ///< of comparisonNames()
    int referenceSamples = 1024;  ///< per pixel; then it is done

    /// The pipeline and parameters of `kept settings`.
    RenderSettings kept;

    bool isOn() const { return with != 0; }
    bool isReference() const;
    bool isKept() const;
    /// Keeps these settings, and chooses them.
    void keep(const RenderSettings& settings);
};

/// Of what is compared with a picture made by `settings`: the same where nothing is. A denoiser gets the
/// picture's integrator, or paths where that takes none, and a reference is the mean of the same. It has
/// other random numbers, and goes through the pixels' centres where the picture does. Kept settings have the
/// picture's random numbers: both see the same noise.
RenderSettings comparisonSettings(const ComparisonChoice& choice, const RenderSettings& settings);

/// PSNR and FLIP of one picture against another, computed beside the rendering.
class LiveScores {
  public:
    /// Begins to, unless it still does.
    void compare(image::Image test, image::Image reference, float exposure);
    bool busy() const { return pending_.valid(); }
    /// Whether there is a result that there was not at the last call.
    bool finish();
    /// The last result; empty before the first.
    const std::string& text() const { return text_; }
    /// FLIP of all results since clear().
    const Track& errors() const { return errors_; }
    /// What is being computed counts no more.
    void clear();

  private:
    struct Scores {
        std::string text;
        std::optional<float> flip;  ///< none: it could not be computed, and `text` says why
    };
    std::future<Scores> pending_;
    Track errors_;
    std::string text_;
    bool discards_ = false;
};

}  // namespace limpid::studio
