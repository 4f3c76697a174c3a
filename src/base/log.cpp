#include "base/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "base/log_receiver.h"
#include "base/text/terminal_text.h"

namespace limpid::log {
namespace {

spdlog::logger& logger() {
    static const auto instance = [] {
        auto created = spdlog::stderr_color_mt("limpid");
        created->set_pattern("%^%l%$: %v");
        return created;
    }();
    return *instance;
}

spdlog::level::level_enum toSpdlog(Level level) {
    switch (level) {
        case Level::Debug:
            return spdlog::level::debug;
        case Level::Info:
            return spdlog::level::info;
        case Level::Warning:
            return spdlog::level::warn;
        case Level::Error:
            return spdlog::level::err;
    }
    return spdlog::level::info;
}

MessageCallback& receiverOfAll() {
    static MessageCallback receiver;
    return receiver;
}

Collector*& collectorOfThread() {
    thread_local Collector* innermost = nullptr;
    return innermost;
}

}  // namespace

void setLevel(Level level) {
    logger().set_level(toSpdlog(level));
}

void setReceiver(MessageCallback receiver) {
    receiverOfAll() = std::move(receiver);
}

Collector::Collector() : outer_(std::exchange(collectorOfThread(), this)) {}

Collector::~Collector() {
    collectorOfThread() = outer_;
}

void Collector::add(const std::string& message) {
    messages_.push_back(message);
    if (outer_) outer_->add(message);
}

void write(Level level, const std::string& message) {
    if (Collector* const collector = collectorOfThread(); collector && level >= Level::Info)
        collector->add(message);
    if (receiverOfAll()) return receiverOfAll()(level, message);
    print(level, message);
}

void print(Level level, const std::string& message) {
    logger().log(toSpdlog(level), terminalText(message, LineBreaks::Keep));
}

}  // namespace limpid::log
