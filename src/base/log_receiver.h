// Where messages of base/log.h go, for programs that show them elsewhere than on this process's stderr.
#pragma once

#include <string>
#include <vector>

#include "base/message.h"

namespace limpid::log {

/// From now on, write() gives every message to `receiver`. Call it before there are threads that write.
void setReceiver(MessageCallback receiver);

/// As write() without a receiver: to stderr.
void print(MessageLevel level, const std::string& message);

/// Collects what the thread that makes it writes with at least the level Info, while it lives. The messages
/// are also written as ever. Several may be nested: each collects.
class Collector {
  public:
    Collector();
    ~Collector();
    Collector(const Collector&) = delete;
    Collector& operator=(const Collector&) = delete;

    const std::vector<std::string>& messages() const { return messages_; }
    void add(const std::string& message);

  private:
    Collector* outer_;
    std::vector<std::string> messages_;
};

}  // namespace limpid::log
