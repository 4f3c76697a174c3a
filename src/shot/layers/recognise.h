// Finds out which layers a file has, by the conventions of known renderers.
#pragma once

#include <vector>

#include "shot/layers/layer_map.h"

namespace limpid::shot {

/// Returns a map for each picture of the file, after `assignments`. Throws InputError if the file has no
/// colours, what apply() throws, and UsageError if an assignment names no role.
std::vector<LayerMap> recognise(const image::ExrDocument& file, const Assignments& assignments);

}  // namespace limpid::shot
