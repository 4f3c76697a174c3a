#include "serve/session/client.h"

#include <algorithm>

#include "base/error.h"
#include "serve/stream/inspection.h"
#include "studio/compare/history_text.h"
#include "studio/loop/mailbox.h"
#include "studio/state/state_json.h"

namespace limpid::serve {
namespace {

using nlohmann::json;

constexpr double messagesPerSecond = 1000.0;         ///< mice of 240 Hz, and the answers to pictures
constexpr double bytesOfAMessage = 65536.0;          ///< so many count as one more message
constexpr size_t maxWaitingBytes = size_t{4} << 20;  ///< of edits that the renderer has not handled yet
constexpr size_t maxReplies = 4000;                  ///< of a client that does not read them
constexpr double betweenFacts = 0.1;                 ///< seconds

template <typename... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace

Client::Client(studio::Session& session, Streamer& streamer, const SceneFiles& files, uint64_t uploads)
    : session_(session),
      streamer_(streamer),
      files_(files),
      uploads_(uploads),
      stream_(streamer.add()),
      allowance_(messagesPerSecond) {}

Client::~Client() {
    streamer_.remove(stream_);
}

/// Long messages count for more.
bool Client::isWithinRate(size_t bytes) {
    const auto now = Clock::now();
    allowance_ +=
        messagesPerSecond * std::chrono::duration<double>(now - std::exchange(allowanceAt_, now)).count();
    allowance_ = std::min(allowance_, messagesPerSecond) - 1.0 - static_cast<double>(bytes) / bytesOfAMessage;
    return allowance_ >= 0.0;
}

/// The renderer keeps all edits until its frame ends, but of those of all lights the newest one only.
bool Client::isWithinMemory() {
    const uint64_t handled = session_.shown()->messages;
    while (!waiting_.empty() && waiting_.front().number <= handled) {
        waitingBytes_ -= waiting_.front().bytes;
        waiting_.pop_front();
    }
    return waitingBytes_ <= maxWaitingBytes;
}

uint64_t Client::edit(nlohmann::json changes, size_t bytes) {
    const bool replaces = studio::isOfLightsAlone(changes);
    const uint64_t number = session_.edit(std::move(changes));
    if (!replaces) {
        waiting_.push_back({number, bytes});
        waitingBytes_ += bytes;
    }
    return number;
}

bool Client::receive(std::string_view part, bool last) {
    if (partial_.size() + part.size() > maxTextBytes) return false;
    partial_ += part;
    if (!last) return true;
    const std::string text = std::exchange(partial_, {});
    if (!isWithinRate(text.size()) || !isWithinMemory()) return false;
    try {
        handle(text);
    } catch (const UsageError& fault) {
        replies_.push_back(
            // The text may quote the client's, cut within a character.
            json{{"type", "refused"}, {"why", fault.what()}}.dump(-1, ' ', true,
                                                                  json::error_handler_t::replace));
    }
    return replies_.size() <= maxReplies;
}

void Client::handle(std::string_view text) {
    ClientMessage message = parseMessage(text);
    uint64_t number = 0;
    std::visit(Overloaded{[&](const Start& start) { streamer_.start(stream_, start.vp9, start.jpegFirst); },
                          [&](const Received& received) { streamer_.received(stream_, received.frame); },
                          [&](Edit& edit) { number = this->edit(std::move(edit.changes), text.size()); },
                          [&](const studio::Gesture& gesture) { number = session_.steer(gesture); },
                          [&](studio::Request& request) { number = session_.ask(std::move(request)); },
                          [&](const Open& open) {
                              const std::string file = files_.find(open.scene);
                              const bool builtin = file.starts_with("builtin:");
                              number = session_.ask({.kind = builtin ? studio::Request::Kind::Open
                                                                     : studio::Request::Kind::OpenDropped,
                                                     .file = file});
                          },
                          [&](const Read& read) {
                              const auto shown = session_.shown();
                              json reply = valuesAt(shown->inspected.get(), read.position);
                              if (shown->reasons)
                                  reply["history"] = studio::historyText(*shown->reasons, read.position);
                              reply.update({{"type", "values"}, {"id", message.id}});
                              replies_.push_back(reply.dump());
                          }},
               message.content);
    if (number > 0) replies_.push_back(json{{"type", "ack"}, {"id", message.id}, {"message", number}}.dump());
}

std::optional<std::string> Client::nextText() {
    if (!std::exchange(greeted_, true))
        return helloMessage(files_.names(), uploads_).dump(-1, ' ', true, json::error_handler_t::replace);
    if (!replies_.empty()) {
        std::string reply = std::move(replies_.front());
        replies_.pop_front();
        return reply;
    }
    const auto shown = session_.shown();
    if (shown->number == 0 || shown->number == snapshot_) return std::nullopt;
    if (std::string text = stateText(*shown); !text.empty()) return text;
    // What is told of the snapshot's facts waits a little, unless the renderer stops: then nothing else would
    // tell it.
    const auto now = Clock::now();
    const bool due = std::chrono::duration<double>(now - factsAt_).count() >= betweenFacts;
    if (!due && shown->facts.computing) return std::nullopt;
    factsAt_ = now;
    snapshot_ = shown->number;
    json facts = studio::toJson(shown->facts);
    const json changes = studio::changesOf(facts_, facts);
    facts_ = std::move(facts);
    if (changes.empty()) return std::nullopt;
    return json{{"type", "facts"}, {"facts", changes}}.dump(-1, ' ', true, json::error_handler_t::replace);
}

std::string Client::stateText(const studio::Shown& shown) {
    json state = studio::toJson(shown.state);
    const json changes = studio::changesOf(state_, state);
    state_ = std::move(state);
    if (changes.empty() && std::exchange(message_, shown.messages) == shown.messages) return {};
    message_ = shown.messages;
    return json{{"type", "state"}, {"state", changes}, {"message", shown.messages}}.dump(
        -1, ' ', true, json::error_handler_t::replace);
}

}  // namespace limpid::serve
