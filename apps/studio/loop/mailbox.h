// What goes between the thread of the renderer and those of its clients.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <variant>

#include "studio/session.h"

namespace limpid::studio {

struct Message {
    uint64_t number = 0;
    std::variant<nlohmann::json, Gesture, Request> content;
};

/// Whether an edit sets all lights and nothing else.
bool isOfLightsAlone(const nlohmann::json& changes);
/// Lights that are dragged are hundreds of kilobytes in some scenes, many times a second: removes the last
/// such edit from messages that wait, if `newer` is another one.
void dropReplaced(std::deque<Message>& messages, const Message& newer);

/// All functions may be called on any thread.
class Mailbox {
  public:
    Mailbox() : shown_(std::make_shared<Shown>()) {}

    /// Returns the message's number. Gestures that follow one another become one, and the newest lights
    /// replace those before.
    uint64_t post(std::variant<nlohmann::json, Gesture, Request> content);
    /// All messages since the last call. Waits until there is one, close() is called, or the time is over.
    std::deque<Message> take(double seconds);
    /// The first messages since then, as long as they are wanted, without waiting.
    std::deque<Message> takeFirst(bool (*wanted)(const Message&));
    /// Whether there is a message that makes the frame that is being rendered useless.
    bool hasUrgentMail() const;
    void close();
    bool isClosed() const;

    void publish(std::shared_ptr<const Shown> shown);
    std::shared_ptr<const Shown> shown() const;
    uint64_t addListener(std::function<void()> listener);
    void removeListener(uint64_t number);

  private:
    mutable std::mutex mutex_;
    std::condition_variable arrived_;
    std::deque<Message> messages_;
    uint64_t posted_ = 0;
    bool closed_ = false;
    std::shared_ptr<const Shown> shown_;
    std::mutex listening_;  ///< held while listeners are called, so that a removed one is not called any more
    std::map<uint64_t, std::function<void()>> listeners_;
    uint64_t listenersEver_ = 0;
};

}  // namespace limpid::studio
