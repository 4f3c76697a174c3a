// How renderers name and encode the layers of their EXR files. docs/denoise-your-renders.md describes each.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "shot/layers/layer_map.h"

namespace limpid::shot {

/// One way to get a layer: the first whose channels exist is taken.
struct Rule {
    std::string_view role;
    std::string_view expression;
    bool partial = false;  ///< terms without channels are left out
};

/// Changes an encoding if a rule was taken, for renderers that have several kinds of a layer.
struct EncodingRule {
    std::string_view role, expression;
    void (*set)(Encoding&);
};

struct Convention {
    std::string_view renderer;
    /// The beauty: a file has a picture for each layer that ends so. Its component A is alpha.
    std::vector<std::string_view> beauties;
    /// One of these must exist as well, unless there are none: a layer, or an attribute after '@' ("@name",
    /// or "@name=beginning of its text").
    std::vector<std::string_view> evidence{};
    std::vector<Rule> rules;
    Encoding encoding{};
    std::vector<EncodingRule> encodingRules{};
    std::string_view group{};  ///< how layers of light groups begin: "Combined_"; empty if there are none
    /// The noisy beauty of files whose beauty the renderer has denoised itself; empty if there is none.
    std::string_view noisy{};
    /// Samples count for one pixel only, so noise is independent from pixel to pixel: other filters spread
    /// each sample over several. Recovery needs it.
    bool hasIndependentPixels = false;
    /// The prefix of a picture that was made of the others; empty if there is none.
    std::string_view composite{};
};

/// From the most to the least specific; the last fits every file with colours.
std::span<const Convention> conventions();

}  // namespace limpid::shot
