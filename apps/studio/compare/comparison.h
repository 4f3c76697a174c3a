// What the picture is compared with: another integrator or denoiser on the same frames, or a reference that
// converges.
#pragma once

#include <future>
#include <string>
#include <vector>

#include "studio/live_render.h"

namespace limpid::studio {

/// The choices: nothing, each integrator alone, each denoiser on what is shown, the reference.
std::vector<std::string> comparisonNames();

struct ComparisonChoice {
    int with = 0;                 ///< of comparisonNames()
    int referenceSamples = 1024;  ///< per pixel; then it is done

    bool isOn() const { return with != 0; }
    bool isReference() const;
};

/// Of what is compared with a picture made by `settings`. A denoiser gets the picture's integrator, or paths
/// where that takes none, and a reference is the mean of the same. It has other random numbers, and goes
/// through the pixels' centres where the picture does.
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
    /// What is being computed counts no more.
    void clear();

  private:
    std::future<std::string> pending_;
    std::string text_;
    bool discards_ = false;
};

}  // namespace limpid::studio
