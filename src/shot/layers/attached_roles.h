// Layers in files of their own: `limpid denoise --file albedo=albedo.exr`.
#pragma once

#include <string>
#include <vector>

#include "shot/layers/layer_map.h"

namespace limpid::shot {

/// Gives the map the roles that attached parts are named after. Of a part's layers with as many components as
/// the role, the one that has the role's name is meant, else the only one. If neither exists, the map stays.
void addAttachedRoles(const ChannelTable& table, LayerMap& map);

/// Throws UsageError, which says why, if no map reads an attached part. `tables` are of all views.
void requireAttached(const image::ExrDocument& file, const std::vector<ChannelTable>& tables,
                     const std::vector<LayerMap>& maps);

}  // namespace limpid::shot
