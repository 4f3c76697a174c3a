// Messages from the library to the program that embeds it. The library prints nothing itself.
#pragma once

#include <functional>
#include <string>

namespace limpid {

enum class MessageLevel { Debug, Info, Warning, Error };

/// May be called from any thread that calls the library, and from the Vulkan driver's threads. Must not
/// throw.
using MessageCallback = std::function<void(MessageLevel, const std::string& message)>;

}  // namespace limpid
