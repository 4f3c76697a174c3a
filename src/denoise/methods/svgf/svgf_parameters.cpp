#include <string>

#include "denoise/methods/svgf/svgf.h"

namespace limpid::denoise {
namespace {

using S = SvgfSettings;

/// What is filtered.
void addInput(ParamTable<S>& t) {
    t.add("separate", &S::separate,
          "Filter diffuse and specular light separately; off: their sum, in 0.6 of the time");
    t.add("demodulate", &S::demodulate, "Filter light without albedo; keeps textures sharp");
    t.add("min_albedo", &S::minAlbedo, 1e-3, 1.0, "",
          "Minimum albedo that `demodulate` divides by; lower keeps the colours of dark surfaces apart, "
          "higher limits their noise")
        .slider(1e-3, 1, SliderScale::Logarithmic);
}

/// How light is accumulated, and which history counts.
void addHistory(ParamTable<S>& t) {
    t.add("alpha", &S::alpha, 1e-4, 1.0, "",
          "Minimum weight of a new frame in the running mean; lower is smoother, higher follows changes "
          "faster");
    t.add("alpha_moments", &S::alphaMoments, 1e-4, 1.0, "",
          "Minimum weight of a new frame in the luminance moments, which give the variance; lower is "
          "steadier");
    t.add("alpha_fast", &S::alphaFast, 1e-4, 1.0, "",
          "Minimum weight of a new frame in the fast mean that anti-lag compares with; higher reacts "
          "faster");
    t.add("normal_test", &S::normalTest, -1.0, 1.0, "cosine",
          "Minimum cosine between a previous pixel's normal and the expected one; higher keeps edges, "
          "lower keeps more history")
        .slider(0.5, 1);
    t.add("depth_test", &S::depthTest, 0.0, 1e6, "of the distance",
          "Maximum deviation from the expected distance (world units without `relative`); lower ghosts "
          "less, higher loses less history")
        .slider(0, 1, SliderScale::Logarithmic, 0.001);
    t.add("lobe_test", &S::lobeTest, 0.0, 1000.0, "lobes",
          "Difference of mirrored directions up to which history counts, in widths of the specular lobe "
          "(with `separate`); lower keeps bumps of glossy surfaces sharp in motion and is noisier; 0 is "
          "off")
        .slider(0, 10);
    t.add("relative", &S::relative,
          "Measure `depth_test` relative to the distance, and allow more on tilted planes");
    t.add("search", &S::search, "Search the 3x3 neighbouring pixels if all four bilinear taps are rejected");
    t.add("reflections", &S::reflections,
          "Reproject specular light along the motion of the reflected image instead of the surface (with "
          "`separate`)");
}

/// How changes of light shorten the history.
void addAntilag(ParamTable<S>& t) {
    t.add("antilag", &S::antilag, 0.0, 1e6, "",
          "History dropped per relative change of light beyond noise; higher follows changes faster and "
          "is noisier; below 0.1 is off");
    t.add("antilag_noise", &S::antilagNoise, 0.0, 100.0, "deviations",
          "Change of a tile's mean that still counts as noise; lower detects smaller changes and more "
          "false ones")
        .slider(0, 10);
    t.add("antilag_pixel", &S::antilagPixel, 0.0, 1e6, "deviations",
          "Maximum contribution of one pixel to a tile's mean; higher measures large changes better, but "
          "above `antilag_noise` one firefly can trigger anti-lag; below an eighth of it anti-lag never "
          "acts")
        .slider(0, 10);
    t.add("antilag_around", &S::antilagAround,
          "Look for changes in 3x3 tiles together, too; finds small changes over large areas, which the "
          "noise of one tile hides");
}

/// What is done about single bright pixels and short histories, and against flicker.
void addRepairs(ParamTable<S>& t) {
    t.add("fireflies", &S::fireflies, 0.0, 1e6, "deviations",
          "Light above its neighbours' mean that a pixel may have in its first frame (4 times as much in "
          "its second, and so on); lower leaves fewer bright blots after a cut and loses more light; 0 is "
          "off")
        .slider(0, 50);
    t.add("young_radius", &S::youngRadius, 0, 16, "pixels",
          "Reach of the first filter pass where there is only one frame yet (half as far with four); more "
          "is smoother and slower there; 0 (and fewer than 2 levels) is off");
    t.add("stabilisation_alpha", &S::stabilisationAlpha, 0.01, 1.0, "",
          "Minimum weight of a frame's filtered light in the stabilised mean; lower flickers less and "
          "follows changes later; 1 (and 0 levels) is off");
    t.add("stabilisation_noise", &S::stabilisationNoise, 0.0, 100.0, "deviations",
          "Difference from the filtered light up to which stabilised history counts in full; higher "
          "flickers less and follows changes later")
        .slider(0, 5);
}

/// The filter in space: its reach, and what stops it.
void addLevels(ParamTable<S>& t) {
    t.add("levels", &S::levels, 0, 10, "levels",
          "Number of filter passes; n passes reach 2^n - 1 pixels, with `wide` 2^(n+1) - 2; more is "
          "smoother and slower");
    t.add("history_level", &S::historyLevel, 0, 10, "levels",
          "Filter pass whose result becomes the next frame's history; higher is smoother and blurs over "
          "time");
    t.add("wide", &S::wide, "5x5 taps per pass; off: 3x3, half the reach in half the time");
    t.add("phi_color", &S::phiColor, 1e-6, 1e9, "deviations",
          "Tolerated difference of luminance; higher smooths across shadows");
    t.add("phi_normal", &S::phiNormal, 1e-6, 1e5, "",
          "Sharpness of the comparison of normals; lower smooths across edges (with `position`: tolerated "
          "distance of normals; higher smooths across edges)");
    t.add("phi_depth", &S::phiDepth, 1e-6, 1e9, "slopes",
          "Tolerated difference of distance, relative to the surface's slope (with `position`: distance "
          "of points in world units); higher smooths across steps");
    t.add("phi_roughness", &S::phiRoughness, 0.0, 1e9, "",
          "Tolerated difference of roughness (with `separate`); lower keeps patterns of gloss apart; 0: "
          "any difference")
        .slider(1e-2, 1, SliderScale::Logarithmic);
}

/// What the filter takes for noise.
void addNoise(ParamTable<S>& t) {
    t.add("blur_levels", &S::blurLevels, 0, 10, "levels",
          "Number of first passes that use a variance averaged over 3x3 pixels; more is steadier and "
          "slower");
    t.add("mean_levels", &S::meanLevels, 0, 10, "levels",
          "Number of first passes that compare each neighbour's luminance with a mean around the pixel "
          "instead of the pixel's own; more leaves less of a fine weave on noisy walls and is slower");
    t.add("damp_outliers", &S::dampOutliers,
          "From the second pass on, let a pixel that is noisier than its neighbours count less in its own "
          "mean; leaves no dots where fireflies were");
    t.add("boost", &S::boost,
          "Let the expected noise fall with the length of the history (by 2 / sqrt(frames)); off: use "
          "the noise of one frame");
    t.add("sample_variance", &S::sampleVariance,
          "With several samples a pixel, take the noise of a history's first frames from the samples' own "
          "variance; off: from the pixels around, which takes detail for noise");
    t.add("position", &S::position,
          "Weigh neighbours by distances of points and normals instead of slopes and cosines");
}

}  // namespace

const ParamTable<SvgfSettings>& svgf::params() {
    static const auto table = [] {
        ParamTable<S> t("svgf");
        addInput(t);
        addHistory(t);
        addAntilag(t);
        addRepairs(t);
        addLevels(t);
        addNoise(t);
        return t;
    }();
    return table;
}

}  // namespace limpid::denoise
