#include "studio/loop/mailbox.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <string_view>

namespace limpid::studio {

using nlohmann::json;

namespace {

/// Fields that a picture can be shown otherwise by, without another frame.
constexpr std::array<std::string_view, 13> harmless{
    "exposure", "tone_curve",  "pass",    "image",   "view.channels",     "view.stops",   "view.false_color",
    "arrows",   "max_samples", "running", "compare", "reference_samples", "kept_settings"};

bool isUrgent(const Message& message) {
    if (std::holds_alternative<Gesture>(message.content)) return true;
    if (const Request* const request = std::get_if<Request>(&message.content)) {
        using Kind = Request::Kind;
        return request->kind == Kind::Reset || request->kind == Kind::ResetCamera ||
               request->kind == Kind::SeeAll || request->kind == Kind::Focus;
    }
    const json& changes = std::get<json>(message.content);
    return std::ranges::any_of(changes.items(), [](const auto& item) {
        return std::ranges::find(harmless, item.key()) == harmless.end();
    });
}

bool setsLights(const Message& message) {
    const json* const changes = std::get_if<json>(&message.content);
    return changes && isOfLightsAlone(*changes);
}

}  // namespace

bool isOfLightsAlone(const json& changes) {
    return changes.is_object() && changes.size() == 1 && changes.contains("lights");
}

void dropReplaced(std::deque<Message>& messages, const Message& newer) {
    if (!setsLights(newer)) return;
    for (auto message = messages.rbegin(); message != messages.rend(); ++message) {
        if (!setsLights(*message)) continue;
        messages.erase(std::next(message).base());
        return;
    }
}

uint64_t Mailbox::post(std::variant<json, Gesture, Request> content) {
    uint64_t number = 0;
    {
        const std::lock_guard lock(mutex_);
        number = ++posted_;
        Message* const last = messages_.empty() ? nullptr : &messages_.back();
        Gesture* const before = last ? std::get_if<Gesture>(&last->content) : nullptr;
        const Gesture* const gesture = std::get_if<Gesture>(&content);
        if (before && gesture) {
            *before += *gesture;
            last->number = number;
        } else {
            Message message{number, std::move(content)};
            dropReplaced(messages_, message);
            messages_.push_back(std::move(message));
        }
    }
    arrived_.notify_one();
    return number;
}

std::deque<Message> Mailbox::take(double seconds) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, std::chrono::duration<double>(seconds),
                      [&] { return closed_ || !messages_.empty(); });
    return std::exchange(messages_, {});
}

std::deque<Message> Mailbox::takeFirst(bool (*wanted)(const Message&)) {
    const std::lock_guard lock(mutex_);
    std::deque<Message> first;
    while (!messages_.empty() && wanted(messages_.front())) {
        first.push_back(std::move(messages_.front()));
        messages_.pop_front();
    }
    return first;
}

bool Mailbox::hasUrgentMail() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(messages_, isUrgent);
}

void Mailbox::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    arrived_.notify_one();
}

bool Mailbox::isClosed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
}

void Mailbox::publish(std::shared_ptr<const Shown> shown) {
    {
        const std::lock_guard lock(mutex_);
        shown_ = std::move(shown);
    }
    const std::lock_guard lock(listening_);
    for (const auto& [number, listener] : listeners_) listener();
}

std::shared_ptr<const Shown> Mailbox::shown() const {
    const std::lock_guard lock(mutex_);
    return shown_;
}

uint64_t Mailbox::addListener(std::function<void()> listener) {
    const std::lock_guard lock(listening_);
    listeners_.emplace(++listenersEver_, std::move(listener));
    return listenersEver_;
}

void Mailbox::removeListener(uint64_t number) {
    const std::lock_guard lock(listening_);
    listeners_.erase(number);
}

}  // namespace limpid::studio
