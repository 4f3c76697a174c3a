// Messages of the library to whoever embeds it. It prints nothing itself.
#pragma once

#include <functional>
#include <string>

namespace limpid {

enum class MessageLevel { Debug, Info, Warning, Error };

/// May be called from any thread that calls the library, and from the Vulkan driver's. It must not throw.
using MessageCallback = std::function<void(MessageLevel, const std::string& message)>;

}  // namespace limpid
