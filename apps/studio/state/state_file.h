// The state in a file, for --state.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "studio/state/state.h"

namespace limpid::studio {

/// Fields by key, as state_json.h has them; those that are missing stay as they are. Throws InputError,
/// naming the file and the key, if it is no such file.
nlohmann::json readStateFile(const std::filesystem::path& file);

/// Throws OutputError.
void writeStateFile(const std::filesystem::path& file, const State& state);

/// What is in such a file, as one line; without lights that are as the scene has them.
std::string stateText(const State& state);

}  // namespace limpid::studio
