// Where messages of base/log.h go, for programs that show them elsewhere than on this process's stderr.
#pragma once

#include <string>

#include "base/message.h"

namespace limpid::log {

/// From now on, write() gives every message to `receiver`. Call it before there are threads that write.
void setReceiver(MessageCallback receiver);

/// As write() without a receiver: to stderr.
void print(MessageLevel level, const std::string& message);

}  // namespace limpid::log
