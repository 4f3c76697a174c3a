// Gives back what a filter took away besides noise.
//
// The residual, noisy minus clean picture, is noise plus what the filter got wrong: blurred highlights,
// shadows that lag behind, the edges of objects. Noise is independent from pixel to pixel and from frame to
// frame, an error is not. So the residual's products with its neighbours and with the frame before tell how
// much of its energy is error, and that share is given back, as in a Wiener filter. With many samples the
// result is close to the noisy picture where the filter is wrong; with few, close to the filter's. The idea
// of combining both by what is known of their errors is in J. Gu et al., "Neural James-Stein Combiner for
// Unbiased and Biased Renderings", and A. Firmino, J. R. Frisvad, H. W. Jensen, "Progressive Denoising of
// Monte Carlo Rendered Images" (both 2022); these estimate variances or train a network, which files of other
// renderers do not allow. docs/denoise-your-renders.md, "Recovery".
#pragma once

#include <optional>
#include <vector>

#include "denoise/api/host_frame.h"
#include "image/image.h"

namespace limpid::shot {

/// Keeps the statistics of one picture of a shot; frames come in the order in which they are denoised.
class Recovery {
  public:
    /// Changes `clean` (RGBA per pixel; alpha stays). `noisy` has three components; values that are not
    /// finite are left out. Of `frame`, depth, normal and motion are read; the motion leads to the frame of
    /// the last call, if `continues`. `samples` per pixel; 0: unknown, taken as 1.
    void apply(std::vector<float>& clean, const image::Image& noisy, const denoise::HostFrame& frame,
               uint32_t samples, bool continues);

  private:
    /// One frame's relative residual, and the running means of its products: with the frame before, with
    /// the four neighbours, with itself; three components each.
    struct Past {
        image::Image residual, products;
    };
    std::optional<Past> past_;
};

}  // namespace limpid::shot
