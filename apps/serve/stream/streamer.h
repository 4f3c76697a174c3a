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

#include "serve/session/protocol.h"
#include "serve/stream/inspection.h"
#include "serve/stream/pace.h"
#include "serve/stream/stream_settings.h"
#include "serve/stream/video_encoder.h"

namespace limpid::serve {

using Bytes = std::shared_ptr<const std::vector<std::byte>>;

/// A picture, or the motion, for one client.
struct Packet {
    FrameHeader header;
    Bytes bytes;
    std::chrono::steady_clock::time_point encoded{};
};

class Streamer {
  public:
    /// `wake` is called on the streamer's thread when there is something to send. The session outlives this.
    Streamer(studio::Session& session, std::function<void()> wake, StreamSettings settings = {});
    ~Streamer();

    /// Ends the thread; nobody is woken any more.
    void stop();

    // All functions may be called on any thread.
    using ClientId = uint64_t;
    ClientId add();
    void remove(ClientId id);
    /// The client has no picture. `jpegFirst`: it shows JPEG, too, and gets it while no video is encoded yet.
    void start(ClientId id, bool vp9, bool jpegFirst = false);
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

    /// The picture or the image of a pass; what it is compared with; the motion.
    enum LaneNumber { mainLane, comparedLane, motionLane, laneCount };
    /// What a client has of one of these.
    struct Lane {
        uint32_t inFlight = 0;
        std::optional<Packet> waiting;  ///< encoded, and not taken yet
        bool synced = false;            ///< has all video frames since a key frame
        bool joins = true;              ///< has had nothing but JPEG since it started
        bool still = false;             ///< the last one was lossless
        std::shared_ptr<const void> last;
    };
    struct Sent {
        int lane;
        Clock::time_point when;
    };
    struct Client {
        uint32_t starts = 0;  ///< how often it has started
        bool vp9 = false, jpegFirst = false;
        std::array<Lane, laneCount> lanes;
        std::map<uint32_t, Sent> sent;
        uint32_t frames = 0;
        double shortestDelay = 0.0;  ///< seconds from sending to the answer; 0: unknown
        double share = 0.5;          ///< of the highest bitrate
        void noteDelay(double seconds);
    };
    /// A client that something is encoded for. It may have started again when that is done, with another
    /// codec and a new decoder: then it gets nothing of it.
    struct Recipient {
        ClientId id = 0;
        uint32_t starts = 0;
    };
    /// What is made for a lane, shared by all clients.
    struct Video {
        std::optional<VideoEncoder> encoder;
        Clock::time_point lastFrame{}, lastKey{};
        Pace pace, jpegPace;
        std::shared_ptr<const void> paced, jpegPaced;  ///< what was last asked whether it is due
        std::optional<Clock::time_point> keyDue;  ///< clients wait for a key frame, which may be made then
    };
    /// What is in the main lane.
    struct Resting {
        std::shared_ptr<const void> what;
        studio::InspectorView view;
        bool operator==(const Resting&) const = default;
    };

    void run();
    double step();
    double secondsToNext(const studio::Shown& shown) const;
    bool streamPicture(int lane, const studio::Shown& shown);
    bool streamMotion(const studio::Shown& shown);
    FrameHeader headerOf(Codec codec, int lane, const studio::Shown& shown,
                         const studio::Picture& picture) const;
    bool mayForceKey(int lane, std::vector<Recipient>& recipients, Clock::time_point now);
    static bool isDue(const Pace& pace, std::shared_ptr<const void>& seen,
                      const std::shared_ptr<const void>& what);
    double shareOf(const std::vector<Recipient>& recipients) const;
    bool encodeVideo(int lane, const studio::Shown& shown,
                     const std::shared_ptr<const studio::Picture>& picture);
    bool encodeJpegs(int lane, const studio::Shown& shown,
                     const std::shared_ptr<const studio::Picture>& picture);
    bool encodeStills(int lane, const studio::Shown& shown,
                      const std::shared_ptr<const studio::Picture>& picture);
    bool answerStillRequests(const studio::Shown& shown);
    template <typename Condition>
    std::vector<Recipient> recipients(int lane, Condition condition) const;
    bool wantsVideo() const;
    VideoEncoder& encoderFor(Video& video, const studio::Picture& picture, uint32_t bitsPerSecond);
    std::vector<Recipient> ready(int lane, bool video, const std::shared_ptr<const void>& what) const;
    void hand(const std::vector<Recipient>& recipients, int lane, FrameHeader header, const Bytes& bytes,
              const std::shared_ptr<const void>& what);
    Bytes stillOf(const std::shared_ptr<const studio::Picture>& picture);

    void note(Stage stage, double milliseconds) const;

    studio::Session& session_;
    std::function<void()> wake_;
    StreamSettings settings_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    bool ends_ = false, news_ = false;
    std::map<ClientId, Client> clients_;
    ClientId clientsEver_ = 0;
    std::vector<std::function<void(Bytes)>> stillRequests_;
    uint64_t listener_ = 0;

    // Of the streamer's thread alone.
    std::array<Video, laneCount> videos_;
    InspectedPicture inspected_;
    std::shared_ptr<const studio::Picture> stillPicture_;
    Bytes still_;
    Resting resting_;  ///< the newest, and since when it is the newest
    Clock::time_point restsSince_{};
    std::thread thread_;
};

}  // namespace limpid::serve
