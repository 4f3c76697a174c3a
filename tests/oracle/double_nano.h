// The networks and the filter of the denoisers `nano` and `film` in double precision, written only from the
// formulas of docs/nano.md, docs/film.md and of the program that trained them. They start from what SVGF's
// stages stored. Nothing is rounded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "shaders/common/camera.h"
#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {

/// By level, from the finest on: channels, and 3x3 layers on the way down.
struct NanoShapeOf {
    std::array<size_t, 5> widths, depths;
};
inline constexpr NanoShapeOf shapeOfNano{{16, 32, 48, 64, 64}, {0, 1, 2, 2, 2}};
inline constexpr NanoShapeOf shapeOfFilm{{48, 96, 128, 128, 128}, {1, 2, 2, 2, 2}};

/// What SVGF's stages stored of one signal: light without albedo, row 0 first.
struct NanoSignal {
    std::vector<dvec4> accumulated;  ///< and the deviation of its luminance
    std::vector<dvec4> first;        ///< after the first level
    std::vector<dvec4> filtered;     ///< after the last level
    std::vector<dvec3> past;         ///< stabilised light of before; empty: `filtered` stands for it
    std::vector<double> frames;      ///< of the history
    std::vector<dvec3> albedo;
};

struct NanoFrame {
    uint32_t width = 0, height = 0;
    CameraParams camera;
    SvgfSurfaces surfaces;
    std::vector<NanoSignal> signals;  ///< one or two; a second one that is missing is black
    double strength = 1.0;
};

/// The result for one signal.
struct NanoLight {
    std::vector<dvec3> light;
    /// How far the light moves, to first order, if all logits are wrong by 1: bounds what rounding in the
    /// network does.
    std::vector<dvec3> spread;
};

/// `weights`: halves, in the order of nano_network.h.
std::array<NanoLight, 2> nanoFilter(const NanoFrame& frame, const NanoShapeOf& shape,
                                    std::span<const std::byte> weights);

}  // namespace limpid::test
