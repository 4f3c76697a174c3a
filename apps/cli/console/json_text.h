// JSON for --json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace limpid::cli {

/// The document, indented. Names of files need not be UTF-8, JSON must be: other bytes become U+FFFD.
inline std::string jsonText(const nlohmann::json& document) {
    return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace limpid::cli
