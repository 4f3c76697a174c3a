// Finds out which layers a file has, by the conventions of known renderers.
#pragma once

#include <vector>

#include "shot/layers/layer_map.h"

namespace limpid::shot {

/// Returns a map for each picture of the file, after `assignments`. Parts that are attached under a role's
/// name win over the file's layers, and assignments over both. Throws InputError if the file has no colours,
/// what apply() throws, and UsageError if an assignment names no role or an attached part is not used.
std::vector<LayerMap> recognise(const image::ExrDocument& file, const Assignments& assignments);

}  // namespace limpid::shot
