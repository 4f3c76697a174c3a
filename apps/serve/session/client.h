// What the server knows of one WebSocket: its limits, what it was told, and what it still has to be told.
#pragma once

#include <chrono>
#include <deque>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "serve/stream/streamer.h"
#include "serve/web/scene_files.h"
#include "studio/session.h"

namespace limpid::serve {

class Client {
  public:
    /// All outlive this. `uploads`: bytes of the largest file that may be uploaded.
    Client(studio::Session& session, Streamer& streamer, const SceneFiles& files, uint64_t uploads);
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    /// Part of a text. Returns false if the client is to be disconnected: it says too much.
    bool receive(std::string_view part, bool last);
    /// The next text to send, if there is one now.
    std::optional<std::string> nextText();
    /// The next picture to send, if there is one now.
    std::optional<Packet> nextPacket() { return streamer_.take(stream_); }

  private:
    using Clock = std::chrono::steady_clock;

    bool isWithinRate(size_t bytes);
    bool isWithinMemory();
    void handle(std::string_view text);
    uint64_t edit(nlohmann::json changes, size_t bytes);
    std::string stateText(const studio::Shown& shown);

    studio::Session& session_;
    Streamer& streamer_;
    const SceneFiles& files_;
    uint64_t uploads_;
    Streamer::ClientId stream_;
    bool greeted_ = false;
    std::string partial_;  ///< of a text that has not ended
    std::deque<std::string> replies_;
    double allowance_;  ///< messages that the client may still send now
    Clock::time_point allowanceAt_ = Clock::now();
    /// Edits that the renderer may not have handled yet, and the sum of their bytes.
    struct Waiting {
        uint64_t number;
        size_t bytes;
    };
    std::deque<Waiting> waiting_;
    size_t waitingBytes_ = 0;
    nlohmann::json state_, facts_;  ///< as they were told last
    uint64_t snapshot_ = 0, message_ = 0;
    Clock::time_point factsAt_{};
};

}  // namespace limpid::serve
