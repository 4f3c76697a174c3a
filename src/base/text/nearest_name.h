// "Did you mean": the name that was probably meant by a mistyped one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace limpid {

/// The number of letters to insert, delete, replace or swap with their neighbour that turn one text into the
/// other (optimal string alignment distance).
size_t editDistance(std::string_view a, std::string_view b);

/// Returns the most similar name, the first one of several; "" if none is similar: at most 1 edit for texts
/// of up to 4 letters, 2 for longer ones, or one text begins with the other (at least 3 letters). Case does
/// not matter.
std::string nearestName(std::string_view text, std::span<const std::string> names);

/// Returns "; did you mean 'NAME'?", or "" if no name is similar.
std::string didYouMean(std::string_view text, std::span<const std::string> names);

}  // namespace limpid
