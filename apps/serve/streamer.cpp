#include "serve/streamer.h"

#include <algorithm>
#include <cmath>

#include "base/log.h"
#include "serve/still_encoder.h"

namespace limpid::serve {
namespace {

constexpr double shortestFrame = 1.0 / 60.0;  ///< seconds between two pictures
constexpr double restSeconds = 0.25;          ///< after which a picture is sent losslessly
constexpr double betweenForcedKeys = 0.5;  ///< seconds: a slow client must not turn the video into key frames
constexpr double highestBitsPerPixel = 0.16;
constexpr double framesASecond = 60.0;
constexpr uint32_t maxThreads = 8;

// How the bitrate follows a connection: down where answers come later than those of an empty one, else slowly
// up.
constexpr double slower = 0.85, faster = 1.03, leastShare = 0.02, lateFactor = 1.5, lateSeconds = 0.03;

double secondsBetween(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

/// A picture is coarse while something moves, if the resolution is automatic.
bool isFull(const studio::Shown& shown) {
    return shown.picture && (shown.state.resolution != studio::Resolution::Automatic ||
                             shown.picture->extent == shown.state.viewport);
}

FrameHeader headerOf(Codec codec, int lane, const studio::Shown& shown, const studio::Picture& picture) {
    return {.codec = codec,
            .compared = lane == 1,
            .width = static_cast<uint16_t>(picture.extent.width),
            .height = static_cast<uint16_t>(picture.extent.height),
            .message = shown.messages,
            .snapshot = shown.number};
}

}  // namespace

Streamer::Streamer(studio::Session& session, std::function<void()> wake)
    : session_(session), wake_(std::move(wake)) {
    listener_ = session_.addListener([this] {
        {
            const std::lock_guard lock(mutex_);
            news_ = true;
        }
        changed_.notify_one();
    });
    thread_ = std::thread([this] { run(); });
}

Streamer::~Streamer() {
    stop();
}

void Streamer::stop() {
    if (!thread_.joinable()) return;
    session_.removeListener(listener_);
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

Streamer::ClientId Streamer::add() {
    const std::lock_guard lock(mutex_);
    clients_.try_emplace(++clientsEver_);
    return clientsEver_;
}

void Streamer::remove(ClientId id) {
    const std::lock_guard lock(mutex_);
    clients_.erase(id);
}

void Streamer::start(ClientId id, bool vp9) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = clients_.find(id);
        if (found == clients_.end()) return;
        found->second.started = true;
        found->second.vp9 = vp9;
        // A client that starts again, say with the other codec, has nothing.
        for (Lane& lane : found->second.lanes) {
            lane.synced = lane.still = false;
            lane.waiting.reset();
            lane.last = nullptr;
        }
        news_ = true;
    }
    changed_.notify_one();
}

void Streamer::received(ClientId id, uint32_t frame) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = clients_.find(id);
        if (found == clients_.end()) return;
        Client& client = found->second;
        const auto sent = client.sent.find(frame);
        if (sent == client.sent.end()) return;
        const double delay = secondsBetween(sent->second.when, Clock::now());
        --client.lanes[static_cast<size_t>(sent->second.lane)].inFlight;
        client.sent.erase(sent);
        if (client.shortestDelay == 0.0 || delay < client.shortestDelay) client.shortestDelay = delay;
        const bool late = delay > lateFactor * client.shortestDelay + lateSeconds;
        client.share = std::clamp(client.share * (late ? slower : faster), leastShare, 1.0);
        news_ = true;
    }
    changed_.notify_one();
}

std::optional<Packet> Streamer::take(ClientId id) {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(id);
    if (found == clients_.end()) return std::nullopt;
    Client& client = found->second;
    for (size_t i = 0; i < client.lanes.size(); ++i) {
        Lane& lane = client.lanes[i];
        if (!lane.waiting) continue;
        Packet packet = std::move(*lane.waiting);
        lane.waiting.reset();
        packet.header.frame = ++client.frames;
        client.sent[packet.header.frame] = {static_cast<int>(i), Clock::now()};
        ++lane.inFlight;
        return packet;
    }
    return std::nullopt;
}

void Streamer::requestStill(std::function<void(Bytes)> done) {
    {
        const std::lock_guard lock(mutex_);
        stillRequests_.push_back(std::move(done));
        news_ = true;
    }
    changed_.notify_one();
}

void Streamer::run() {
    double patience = 0.0;
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            const auto isDue = [&] { return ends_ || news_; };
            changed_.wait_for(lock, std::chrono::duration<double>(patience), isDue);
            if (ends_) return;
            news_ = false;
        }
        try {
            patience = step();
        } catch (const std::exception& fault) {
            log::error("the stream: {}", fault.what());
            patience = 1.0;
        }
    }
}

/// Encodes what clients can take. Returns the seconds until there may be something to do although nothing has
/// happened.
double Streamer::step() {
    const auto shown = session_.shown();
    const auto now = Clock::now();
    if (resting_ != shown->picture) {
        resting_ = shown->picture;
        restsSince_ = now;
    }
    bool sent = answerStillRequests(*shown);
    for (int lane = 0; lane < 2; ++lane) sent |= streamLane(lane, *shown);
    if (sent) wake_();
    // Clients that lost a frame may get a key frame by then, also if the next picture takes long.
    double patience = betweenForcedKeys;
    const auto after = Clock::now();
    for (const Video& video : videos_) {
        const double since = secondsBetween(std::max(video.lastFrame, video.lastJpeg), after);
        if (since < shortestFrame) patience = std::min(patience, shortestFrame - since + 0.0002);
    }
    const double rested = secondsBetween(restsSince_, after);
    if (!shown->facts.computing && shown->picture && rested < restSeconds)
        patience = std::min(patience, restSeconds - rested + 0.001);
    return patience;
}

bool Streamer::streamLane(int number, const studio::Shown& shown) {
    const auto& picture = number == 0 ? shown.picture : shown.compared;
    if (!picture || picture->extent.width == 0) return false;
    bool sent = encodeVideo(number, shown, picture);
    sent |= encodeJpegs(number, shown, picture);
    sent |= encodeStills(number, shown, picture);
    return sent;
}

/// The clients that can take this picture and do not have it.
std::vector<Streamer::ClientId> Streamer::ready(int number, bool vp9,
                                                const std::shared_ptr<const studio::Picture>& picture) const {
    const std::lock_guard lock(mutex_);
    std::vector<ClientId> ids;
    for (const auto& [id, client] : clients_) {
        const Lane& lane = client.lanes[static_cast<size_t>(number)];
        if (client.started && client.vp9 == vp9 && !lane.waiting && lane.inFlight < maxInFlight &&
            lane.last != picture)
            ids.push_back(id);
    }
    return ids;
}

void Streamer::hand(const std::vector<ClientId>& ids, int number, FrameHeader header, const Bytes& bytes,
                    const std::shared_ptr<const studio::Picture>& picture) {
    const std::lock_guard lock(mutex_);
    for (const ClientId id : ids) {
        const auto found = clients_.find(id);
        if (found == clients_.end()) continue;
        Lane& lane = found->second.lanes[static_cast<size_t>(number)];
        lane.waiting = Packet{header, bytes};
        lane.last = picture;
        lane.still = header.lossless;
        if (header.codec == Codec::Vp9) lane.synced = true;
    }
}

bool Streamer::encodeVideo(int number, const studio::Shown& shown,
                           const std::shared_ptr<const studio::Picture>& picture) {
    std::vector<ClientId> ids = ready(number, true, picture);
    Video& video = videos_[static_cast<size_t>(number)];
    const auto now = Clock::now();
    const double seconds = secondsBetween(video.lastFrame, now);
    if (ids.empty() || seconds < shortestFrame) return false;
    if (!video.encoder || video.encoder->extent() != picture->extent) video.encoder.reset();
    bool key = !video.encoder;
    double share = 1.0;
    {
        const std::lock_guard lock(mutex_);
        const auto synced = [&](ClientId id) {
            const auto found = clients_.find(id);
            return found != clients_.end() && found->second.lanes[static_cast<size_t>(number)].synced;
        };
        const bool mayForce = secondsBetween(video.lastForcedKey, now) >= betweenForcedKeys;
        const bool anyLost = !std::ranges::all_of(ids, synced);
        if (!key && anyLost && mayForce) key = true;
        if (!key) std::erase_if(ids, [&](ClientId id) { return !synced(id); });
        for (const ClientId id : ids) {
            if (const auto found = clients_.find(id); found != clients_.end())
                share = std::min(share, found->second.share);
        }
    }
    if (ids.empty()) return false;
    const double highest =
        highestBitsPerPixel * framesASecond * picture->extent.width * picture->extent.height;
    const auto bits = static_cast<uint32_t>(std::clamp(share * highest, 3e5, 6e7));
    const uint32_t threads = std::clamp(std::thread::hardware_concurrency(), 1u, maxThreads);
    if (!video.encoder) video.encoder.emplace(picture->extent, bits, threads);
    video.encoder->setBitrate(bits);
    VideoEncoder::Frame frame = video.encoder->encode(*picture, key, seconds);
    video.lastFrame = now;
    if (frame.bytes.empty())
        return false;  // the rate control has dropped it: the next one continues the last
    if (frame.key) video.lastForcedKey = now;
    {
        // Who does not get this frame cannot decode the next one.
        const std::lock_guard lock(mutex_);
        for (auto& [id, client] : clients_) client.lanes[static_cast<size_t>(number)].synced = false;
    }
    FrameHeader header = headerOf(Codec::Vp9, number, shown, *picture);
    header.key = frame.key;
    hand(ids, number, header, std::make_shared<const std::vector<std::byte>>(std::move(frame.bytes)),
         picture);
    return true;
}

bool Streamer::encodeJpegs(int number, const studio::Shown& shown,
                           const std::shared_ptr<const studio::Picture>& picture) {
    const std::vector<ClientId> ids = ready(number, false, picture);
    Clock::time_point& last = videos_[static_cast<size_t>(number)].lastJpeg;
    const auto now = Clock::now();
    if (ids.empty() || secondsBetween(last, now) < shortestFrame) return false;
    last = now;
    double share = 1.0;
    {
        const std::lock_guard lock(mutex_);
        for (const ClientId id : ids) {
            if (const auto found = clients_.find(id); found != clients_.end())
                share = std::min(share, found->second.share);
        }
    }
    const int quality = static_cast<int>(std::lround(40.0 + 50.0 * share));
    hand(ids, number, headerOf(Codec::Jpeg, number, shown, *picture),
         std::make_shared<const std::vector<std::byte>>(encodeJpeg(*picture, quality)), picture);
    return true;
}

Bytes Streamer::stillOf(const std::shared_ptr<const studio::Picture>& picture) {
    if (stillPicture_ != picture) {
        still_ = std::make_shared<const std::vector<std::byte>>(encodeStill(*picture));
        stillPicture_ = picture;
    }
    return still_;
}

/// What rests is sent again, without loss.
bool Streamer::encodeStills(int number, const studio::Shown& shown,
                            const std::shared_ptr<const studio::Picture>& picture) {
    const bool rests =
        !shown.facts.computing && isFull(shown) && secondsBetween(restsSince_, Clock::now()) >= restSeconds;
    if (!rests) return false;
    std::vector<ClientId> ids;
    {
        const std::lock_guard lock(mutex_);
        for (const auto& [id, client] : clients_) {
            const Lane& lane = client.lanes[static_cast<size_t>(number)];
            if (client.started && !lane.waiting && lane.inFlight == 0 &&
                !(lane.still && lane.last == picture))
                ids.push_back(id);
        }
    }
    if (ids.empty()) return false;
    FrameHeader header = headerOf(Codec::Png, number, shown, *picture);
    header.lossless = true;
    hand(ids, number, header, stillOf(picture), picture);
    return true;
}

bool Streamer::answerStillRequests(const studio::Shown& shown) {
    if (!isFull(shown)) return false;
    {
        const std::lock_guard lock(mutex_);
        if (stillRequests_.empty()) return false;
    }
    const Bytes still = stillOf(shown.picture);  // may throw: then the requests are answered the next time
    std::vector<std::function<void(Bytes)>> requests;
    {
        const std::lock_guard lock(mutex_);
        requests.swap(stillRequests_);
    }
    for (const auto& request : requests) request(still);
    return true;
}

}  // namespace limpid::serve
