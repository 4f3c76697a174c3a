// Encodes the pictures of a session for several clients, on a thread of its own. Each client gets the newest
// picture as often as it can take one: nothing queues. Does not use the network.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "serve/protocol.h"
#include "serve/video_encoder.h"

namespace limpid::serve {

using Bytes = std::shared_ptr<const std::vector<std::byte>>;

/// A picture for one client.
struct Packet {
    FrameHeader header;
    Bytes bytes;
};

class Streamer {
  public:
    /// `wake` is called on the streamer's thread when there is something to send. The session outlives this.
    Streamer(studio::Session& session, std::function<void()> wake);
    ~Streamer();

    /// Ends the thread; nobody is woken any more.
    void stop();

    // All functions may be called on any thread.
    using ClientId = uint64_t;
    ClientId add();
    void remove(ClientId id);
    void start(ClientId id, bool vp9);
    /// The client has received a frame; unknown numbers are ignored.
    void received(ClientId id, uint32_t frame);
    /// What is to be sent to a client now, if anything.
    std::optional<Packet> take(ClientId id);
    /// Calls the function on the streamer's thread with a PNG file of the newest picture in full size, once
    /// there is one.
    void requestStill(std::function<void(Bytes)> done);

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr uint32_t maxInFlight = 2;

    /// What a client has of one of the two pictures.
    struct Lane {
        uint32_t inFlight = 0;
        std::optional<Packet> waiting;  ///< encoded, and not taken yet
        bool synced = false;            ///< has all video frames since a key frame
        bool still = false;             ///< the last one was lossless
        std::shared_ptr<const studio::Picture> last;
    };
    struct Sent {
        int lane;
        Clock::time_point when;
    };
    struct Client {
        bool started = false, vp9 = false;
        std::array<Lane, 2> lanes;  ///< the picture, and what it is compared with
        std::map<uint32_t, Sent> sent;
        uint32_t frames = 0;
        double shortestDelay = 0.0;  ///< seconds from sending to the answer; 0: unknown
        double share = 0.5;          ///< of the highest bitrate
    };
    /// The video of one of the two pictures, shared by all clients.
    struct Video {
        std::optional<VideoEncoder> encoder;
        Clock::time_point lastFrame{}, lastForcedKey{}, lastJpeg{};
    };

    void run();
    double step();
    bool streamLane(int number, const studio::Shown& shown);
    bool encodeVideo(int lane, const studio::Shown& shown,
                     const std::shared_ptr<const studio::Picture>& picture);
    bool encodeJpegs(int lane, const studio::Shown& shown,
                     const std::shared_ptr<const studio::Picture>& picture);
    bool encodeStills(int lane, const studio::Shown& shown,
                      const std::shared_ptr<const studio::Picture>& picture);
    bool answerStillRequests(const studio::Shown& shown);
    std::vector<ClientId> ready(int lane, bool vp9,
                                const std::shared_ptr<const studio::Picture>& picture) const;
    void hand(const std::vector<ClientId>& ids, int lane, FrameHeader header, const Bytes& bytes,
              const std::shared_ptr<const studio::Picture>& picture);
    Bytes stillOf(const std::shared_ptr<const studio::Picture>& picture);

    studio::Session& session_;
    std::function<void()> wake_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool ends_ = false, news_ = false;
    std::map<ClientId, Client> clients_;
    ClientId clientsEver_ = 0;
    std::vector<std::function<void(Bytes)>> stillRequests_;
    uint64_t listener_ = 0;

    // Of the streamer's thread alone.
    std::array<Video, 2> videos_;
    std::shared_ptr<const studio::Picture> stillPicture_;
    Bytes still_;
    std::shared_ptr<const studio::Picture> resting_;  ///< the newest picture, and since when it is the newest
    Clock::time_point restsSince_{};
    std::thread thread_;
};

}  // namespace limpid::serve
