// The layers of a frame: each has one row here, and all that lists layers follows from the rows. To add one,
// add its row, and write it in the shader of the path tracer (a variable of the row's name).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace limpid {

/// How a layer's channels are stored in EXR files.
enum class Stored : uint8_t {
    Color,  ///< half, or float where the user asks for float colours
    Float,
    Uint,
};

/// What a pixel of a layer is made of: four floats in memory, or two integers for FirstSample. "The
/// components" are those that files have (LayerInfo::suffixes).
enum class Mean : uint8_t {
    OfAll,    ///< the mean over all samples
    OfHits,   ///< over those that hit something. In memory: the mean over all, misses as 0, and after the
              ///< components the share of samples that hit
    OfValid,  ///< over those that have a value; in memory likewise, with the share of samples that have one
    FirstSample,  ///< no mean: the value of the first sample
    Count,        ///< no mean: the number of samples
};

/// What the mean squared deviation over the samples is of. A layer that has one holds it in its fourth float.
enum class VarianceOf : uint8_t { Luminance, FirstComponent, MeanOfComponents, Nothing };

/// Whether a file must have the layer to be denoised.
enum class Need : uint8_t {
    Always,
    InSequences,  ///< if there is a frame before
    Advised,      ///< in sequences the result is worse without it: LayerInfo::without
    Optional,
};

struct LayerInfo {
    std::string_view member;    ///< of LayerSet; the variable of the shaders that write or read it
    std::string_view name;      ///< in files and of --aov; empty in a row: as `member`
    std::string_view suffixes;  ///< a letter for each component: files have the channels `name`.`letter`
    Stored stored = Stored::Color;
    Mean mean = Mean::OfAll;
    VarianceOf varianceOf = VarianceOf::Nothing;
    bool varianceInFiles = false;  ///< files can have its variance: the channel `name`.variance
    bool inBeauty = false;         ///< beauty is the sum of these layers
    bool ofFirstHit = false;       ///< follows from the first surface alone: the G-buffer pass writes it too
    Need need = Need::Optional;
    std::string_view without;  ///< what goes wrong where an advised layer is missing
    std::string_view help;     ///< as in docs/layers.md
    size_t index = 0;          ///< in layerTable

    constexpr bool isMean() const { return mean != Mean::FirstSample && mean != Mean::Count; }
    /// The mean in files is the one in memory divided by the share of samples after it.
    constexpr bool hasShare() const { return mean == Mean::OfHits || mean == Mean::OfValid; }
    /// Floats of a pixel in memory that are means: the components, and the share if there is one.
    constexpr size_t meanComponents() const { return suffixes.size() + (hasShare() ? 1 : 0); }
};

/// In files, in the place of a depth or a motion where no sample has one.
inline constexpr float noValue = 1e10f;

/// The layers that a frame has as images, LAYER(member, columns of LayerInfo that differ from its defaults).
// clang-format off
#define LIMPID_LAYERS(LAYER)                                                                                      \
    LAYER(diffuse,                                                                                                \
          .suffixes = "RGB", .varianceOf = VarianceOf::Luminance, .varianceInFiles = true, .inBeauty = true,      \
          .need = Need::Always,                                                                                   \
          .help = "light that the first surface scatters diffusely, albedo multiplied in")                        \
    LAYER(specular,                                                                                               \
          .suffixes = "RGB", .varianceOf = VarianceOf::Luminance, .varianceInFiles = true, .inBeauty = true,      \
          .need = Need::Always,                                                                                   \
          .help = "light that it reflects or transmits otherwise")                                                \
    LAYER(emission,                                                                                               \
          .suffixes = "RGB", .varianceOf = VarianceOf::Luminance, .inBeauty = true, .ofFirstHit = true,           \
          .need = Need::Always,                                                                                   \
          .help = "emitters and sky that the camera sees directly")                                               \
    LAYER(albedo,                                                                                                 \
          .suffixes = "RGB", .varianceOf = VarianceOf::Luminance, .varianceInFiles = true, .ofFirstHit = true,    \
          .need = Need::Always,                                                                                   \
          .help = "base colour after texture and vertex colour; 0 where nothing is hit")                          \
    LAYER(albedoSpecular,                                                                                         \
          .suffixes = "RGB", .varianceOf = VarianceOf::Luminance, .ofFirstHit = true,                             \
          .help = "what the specular lobes return of uniform light")                                              \
    LAYER(normal,                                                                                                 \
          .suffixes = "XYZ", .varianceOf = VarianceOf::MeanOfComponents, .varianceInFiles = true,                 \
          .ofFirstHit = true, .need = Need::Always,                                                               \
          .help = "world space, facing the viewer; 0 where nothing is hit")                                       \
    LAYER(previousNormal,                                                                                         \
          .name = "prevNormal", .suffixes = "XYZ", .ofFirstHit = true,                                            \
          .need = Need::Advised, .without = "turning objects lose their history",                                 \
          .help = "the same surface point's normal in the previous frame")                                        \
    LAYER(depth,                                                                                                  \
          .suffixes = "Z", .stored = Stored::Float, .mean = Mean::OfHits,                                         \
          .varianceOf = VarianceOf::FirstComponent, .varianceInFiles = true, .ofFirstHit = true,                  \
          .need = Need::Always,                                                                                   \
          .help = "distance from the eye along the ray, world units; 1e10 where nothing is hit")                  \
    LAYER(motion,                                                                                                 \
          .suffixes = "XYZ", .stored = Stored::Float, .mean = Mean::OfValid, .ofFirstHit = true,                  \
          .need = Need::InSequences,                                                                              \
          .help = "previous pixel position (X Y, pixels) and distance (Z) minus this frame's; 1e10: none")        \
    LAYER(reflectionMotion,                                                                                       \
          .suffixes = "XYZ", .stored = Stored::Float, .mean = Mean::OfValid,                                      \
          .help = "likewise, of what flat smooth surfaces reflect; 1e10: unknown")                                \
    LAYER(ids,                                                                                                    \
          .name = "id", .suffixes = "I", .stored = Stored::Uint, .mean = Mean::FirstSample, .ofFirstHit = true,   \
          .need = Need::Advised, .without = "objects that touch share their history",                             \
          .help = "number of the instance plus one at the pixel's centre, 0: nothing")
// clang-format on

/// All layers that an EXR file can have, in the order of docs/layers.md: beauty; the images above; what is
/// told about them.
inline constexpr auto layerTable = [] {
#define LIMPID_LAYER_ROW(layer, ...) LayerInfo{.member = #layer, __VA_ARGS__},
    std::array rows{
        LayerInfo{.member = "beauty",
                  .suffixes = "RGBA",
                  .help = "beauty = diffuse + specular + emission; alpha 1"},
        LIMPID_LAYERS(LIMPID_LAYER_ROW)  //
        LayerInfo{.name = "variance",
                  .stored = Stored::Float,
                  .help = "s^2/N, the variance of the mean: diffuse, specular, albedo, normal, depth"},
        LayerInfo{.name = "samples",
                  .suffixes = "N",
                  .stored = Stored::Float,
                  .mean = Mean::Count,
                  .help = "samples in the means"},
    };
#undef LIMPID_LAYER_ROW
    for (size_t i = 0; i < rows.size(); ++i) {
        rows[i].index = i;
        if (rows[i].name.empty()) rows[i].name = rows[i].member;
    }
    return rows;
}();

inline constexpr const LayerInfo& beautyLayer = layerTable.front();
inline constexpr const LayerInfo& varianceLayer = layerTable[layerTable.size() - 2];
inline constexpr const LayerInfo& samplesLayer = layerTable.back();

/// The layers that a frame has as images.
inline constexpr std::span<const LayerInfo> frameLayers =
    std::span(layerTable).subspan<1, layerTable.size() - 3>();

}  // namespace limpid
