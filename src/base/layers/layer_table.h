// The layers of a frame: one row per layer. Everything that lists layers is generated from the rows. To add
// a layer, add its row, and write it in the path tracer's shader (a variable with the row's name).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace limpid {

/// How EXR files store a layer's channels.
enum class Stored : uint8_t {
    Color,  ///< half, or float if the user chooses float colours
    Float,
    Uint,
};

/// How a pixel of a layer is computed: four floats in memory, or two integers for FirstSample. "The
/// components" are those in files (LayerInfo::suffixes).
enum class Mean : uint8_t {
    OfAll,    ///< the mean over all samples
    OfHits,   ///< the mean over samples that hit something. In memory: the mean over all with misses as 0,
              ///< followed by the share of samples that hit
    OfValid,  ///< the mean over samples that have a value; in memory like OfHits, with the share of samples
              ///< that have one
    FirstSample,  ///< no mean: the value of the first sample
    Count,        ///< no mean: the number of samples
};

/// The quantity whose mean squared deviation over the samples is stored in the layer's fourth float.
enum class VarianceOf : uint8_t { Luminance, FirstComponent, MeanOfComponents, Nothing };

/// How a frame stores the layer if only a filter reads it. OneHalf: the first component alone.
enum class ForFilters : uint8_t { Halves, OneHalf, Floats, Nothing };

/// Whether denoising a file requires the layer.
enum class Need : uint8_t {
    Always,
    InSequences,  ///< required if there is a previous frame
    Advised,      ///< sequences look worse without it: see LayerInfo::without
    Optional,
};

struct LayerInfo {
    std::string_view member;    ///< name in LayerSet, and of the variable in shaders that write or read it
    std::string_view name;      ///< name in files and for --aov; empty in a row: same as `member`
    std::string_view suffixes;  ///< one letter per component: files have the channels `name`.`letter`
    Stored stored = Stored::Color;
    Mean mean = Mean::OfAll;
    VarianceOf varianceOf = VarianceOf::Nothing;
    bool varianceInFiles = false;  ///< files can contain its variance, as channel `name`.variance.V
    bool inBeauty = false;         ///< beauty is the sum of these layers
    bool ofFirstHit = false;       ///< depends on the first hit alone, so the G-buffer pass writes it too
    ForFilters forFilters = ForFilters::Halves;
    Need need = Need::Optional;
    std::string_view without;  ///< what goes wrong without an advised layer
    std::string_view help;     ///< help text, as in docs/layers.md
    size_t index = 0;          ///< index in layerTable

    constexpr bool isMean() const { return mean != Mean::FirstSample && mean != Mean::Count; }
    /// True if memory holds a share of samples. The mean in files is the one in memory divided by that share.
    constexpr bool hasShare() const { return mean == Mean::OfHits || mean == Mean::OfValid; }
    /// Number of floats in memory that are means: the components, and the share if there is one.
    constexpr size_t meanComponents() const { return suffixes.size() + (hasShare() ? 1 : 0); }
};

/// Value in files for a depth or motion where no sample has one.
inline constexpr float noValue = 1e10f;

/// The layers that a frame stores as images: LAYER(member, the columns of LayerInfo that differ from its
/// defaults).
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
          .help = "emitters and sky that the camera sees directly, or as reflections in smooth glass")            \
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
          .forFilters = ForFilters::Floats, .need = Need::Always,                                                 \
          .help = "distance from the eye along the ray, world units; 1e10 where nothing is hit")                  \
    LAYER(motion,                                                                                                 \
          .suffixes = "XYZ", .stored = Stored::Float, .mean = Mean::OfValid, .ofFirstHit = true,                  \
          .need = Need::InSequences,                                                                              \
          .help = "previous pixel position (X Y, pixels) and distance (Z) minus this frame's; 1e10: none")        \
    LAYER(reflectionMotion,                                                                                       \
          .suffixes = "XYZ", .stored = Stored::Float, .mean = Mean::OfValid,                                      \
          .help = "likewise, of what smooth surfaces reflect; 1e10: unknown")                                \
    LAYER(roughness,                                                                                              \
          .suffixes = "R", .ofFirstHit = true, .forFilters = ForFilters::OneHalf,                                 \
          .help = "roughness of the specular lobe; 0 where nothing is hit")                                       \
    LAYER(hitDistance,                                                                                            \
          .suffixes = "D", .stored = Stored::Float, .mean = Mean::OfValid, .forFilters = ForFilters::Nothing,     \
          .help = "length of reflected rays to what they hit, world units; 1e9: nothing; 1e10: unknown")          \
    LAYER(ids,                                                                                                    \
          .name = "id", .suffixes = "I", .stored = Stored::Uint, .mean = Mean::FirstSample, .ofFirstHit = true,   \
          .need = Need::Advised, .without = "objects that touch share their history",                             \
          .help = "number of the instance plus one at the pixel's centre, 0: nothing")
// clang-format on

/// All layers that an EXR file can have, in the order of docs/layers.md: beauty; the images above; derived
/// layers.
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

/// The layers that a frame stores as images.
inline constexpr std::span<const LayerInfo> frameLayers =
    std::span(layerTable).subspan<1, layerTable.size() - 3>();

}  // namespace limpid
