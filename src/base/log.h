// Messages for the user, on stderr; stdout is reserved for results.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

#include "base/message.h"

namespace limpid::log {

using Level = MessageLevel;

/// Messages below this level are dropped. Default: Info.
void setLevel(Level level);

/// Writes a message. Escapes its control characters except line feeds and tabs. Usable as a MessageCallback.
void write(Level level, const std::string& message);

template <typename... Args>
void debug(fmt::format_string<Args...> format, Args&&... args) {
    write(Level::Debug, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void info(fmt::format_string<Args...> format, Args&&... args) {
    write(Level::Info, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void warn(fmt::format_string<Args...> format, Args&&... args) {
    write(Level::Warning, fmt::format(format, std::forward<Args>(args)...));
}
template <typename... Args>
void error(fmt::format_string<Args...> format, Args&&... args) {
    write(Level::Error, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace limpid::log
