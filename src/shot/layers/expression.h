// Sums of products of layers: how a frame's layers follow from those of another renderer's file.
//
//     DiffCol.RGB * DiffDir.RGB + DiffCol.RGB * DiffInd.RGB
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"
#include "shot/layers/channel_table.h"

namespace limpid::shot {

/// A layer and its channels, in the order of the components that were asked for.
struct Factor {
    std::string text;  ///< "Combined.RGB"
    std::vector<ChannelPlace> channels;
};

struct Term {
    float scale = 1.0f;
    std::vector<Factor> factors;
};

/// An expression whose channels exist.
class LayerExpression {
  public:
    /// Looks the layers of `text` up; each stands behind `prefix` in the file ("ViewLayer."). The grammar:
    ///
    ///     expression = term {(" + " | " - ") term}
    ///     term       = factor {" * " factor}
    ///     factor     = number | layer "." components | components
    ///
    /// Blanks around the operators are needed, since names of layers may contain the signs. Each letter of
    /// the components is a channel ("RGB"; "?" is a layer's only channel); a layer in which they are named
    /// otherwise is found, too ("rgb", "red", "X Y Z" for "RGB" and so on). "*.T" is the first
    /// layer with a channel T. Returns nothing if a channel is
    /// missing; with `partial`, terms with missing channels are left out if another one remains. Throws
    /// UsageError if the text is no expression.
    static std::optional<LayerExpression> resolve(std::string_view text, const ChannelTable& table,
                                                  std::string_view prefix = {}, bool partial = false);

    /// As it was resolved.
    std::string text() const;
    const std::vector<Term>& terms() const { return terms_; }
    /// All channels that it reads.
    std::vector<ChannelPlace> places() const;
    /// The number of components of the result.
    uint32_t components() const;
    /// Computes the picture. A factor of one component multiplies all.
    image::Image evaluate(image::ExrDocument& file) const;

  private:
    std::vector<Term> terms_;
};

}  // namespace limpid::shot
