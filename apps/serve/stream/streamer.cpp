#include "serve/stream/streamer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/log.h"
#include "serve/stream/still_encoder.h"

namespace limpid::serve {
namespace {

constexpr double restSeconds = 0.25;  ///< after which a picture is sent losslessly
// Seconds from a key frame to the next that clients need: a slow one must not turn the video into key frames.
// Who has just come sees nothing before it.
constexpr double betweenKeys = 0.5, betweenKeysForNewcomers = 0.1;
constexpr double longestWait = 0.5;  ///< seconds
constexpr double highestBitsPerPixel = 0.16;
constexpr uint32_t lowestBitrate = 300'000;  ///< bits a second
constexpr double highestBitrate = 6e7;
constexpr double framesASecond = 60.0;
constexpr uint32_t maxThreads = 16;

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

/// The renderer, the server and other clients' programs need some cores, too.
uint32_t threadsFor(const StreamSettings& settings) {
    if (settings.encoderThreads > 0) return settings.encoderThreads;
    const uint32_t cores = std::thread::hardware_concurrency();
    return std::clamp(cores - cores / 4, 1u, maxThreads);
}

}  // namespace

Streamer::Streamer(studio::Session& session, std::function<void()> wake, StreamSettings settings)
    : session_(session), wake_(std::move(wake)), settings_(std::move(settings)) {
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

void Streamer::start(ClientId id, bool vp9, bool jpegFirst) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = clients_.find(id);
        if (found == clients_.end()) return;
        ++found->second.starts;
        found->second.vp9 = vp9;
        found->second.jpegFirst = jpegFirst;
        // A client that starts again, say with the other codec, has nothing, and may never acknowledge what
        // was sent before.
        found->second.sent.clear();
        for (Lane& lane : found->second.lanes) {
            lane.inFlight = 0;
            lane.synced = lane.still = false;
            lane.joins = true;
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
        const bool isPicture = sent->second.lane != motionLane;  // what is small comes sooner
        --client.lanes[static_cast<size_t>(sent->second.lane)].inFlight;
        client.sent.erase(sent);
        news_ = true;
        if (isPicture) client.noteDelay(delay);
    }
    changed_.notify_one();
}

/// The bitrate follows the connection.
void Streamer::Client::noteDelay(double seconds) {
    if (shortestDelay == 0.0 || seconds < shortestDelay) shortestDelay = seconds;
    const bool late = seconds > lateFactor * shortestDelay + lateSeconds;
    share = std::clamp(share * (late ? slower : faster), leastShare, 1.0);
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

void Streamer::note(Stage stage, double milliseconds) const {
    if (settings_.timed) settings_.timed(stage, milliseconds);
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
    Resting now{shown->picture, {}};
    if (shown->inspected) now = {shown->inspected, shown->state.view};
    if (resting_ != now) {
        resting_ = std::move(now);
        restsSince_ = Clock::now();
    }
    bool sent = answerStillRequests(*shown);
    for (const int lane : {mainLane, comparedLane}) sent |= streamPicture(lane, *shown);
    sent |= streamMotion(*shown);
    if (sent) wake_();
    return secondsToNext(*shown);
}

double Streamer::secondsToNext(const studio::Shown& shown) const {
    double patience = longestWait;
    const auto now = Clock::now();
    const auto waitFor = [&](double seconds) { patience = std::clamp(seconds, 0.0, patience); };
    for (const Video& video : videos_) {
        for (const Pace& pace : {video.pace, video.jpegPace}) {
            if (!pace.isDue(now, false)) waitFor(secondsBetween(now, pace.latest()));
        }
        if (video.keyDue) waitFor(secondsBetween(now, *video.keyDue));
    }
    const double rested = secondsBetween(restsSince_, now);
    if (!shown.facts.computing && shown.picture && rested < restSeconds) waitFor(restSeconds - rested);
    return patience;
}

bool Streamer::streamPicture(int lane, const studio::Shown& shown) {
    videos_[static_cast<size_t>(lane)].keyDue.reset();
    // To convert the image of a pass takes time: not while nobody can take it.
    if (recipients(lane, [](const Client&, const Lane&) { return true; }).empty()) return false;
    auto picture = lane == mainLane ? shown.picture : shown.compared;
    if (lane == mainLane && shown.inspected) picture = inspected_.of(shown.inspected, shown.state.view);
    if (!picture || picture->extent.width == 0) return false;
    Video& video = videos_[static_cast<size_t>(lane)];
    // An encoder takes 0.1 to 0.2 s to start: the first picture does not wait for it.
    const bool starts = !video.encoder;
    bool sent = starts && encodeJpegs(lane, shown, picture);
    if (sent && wantsVideo()) {
        wake_();
        encoderFor(video, *picture, lowestBitrate);
    }
    sent |= encodeVideo(lane, shown, picture);
    sent |= !starts && encodeJpegs(lane, shown, picture);
    sent |= encodeStills(lane, shown, picture);
    return sent;
}

/// It is small: all clients get it as it is.
bool Streamer::streamMotion(const studio::Shown& shown) {
    Video& video = videos_[motionLane];
    const auto now = Clock::now();
    if (!shown.motion || !video.pace.isDue(now, true)) return false;
    const auto to =
        recipients(motionLane, [&](const Client&, const Lane& lane) { return lane.last != shown.motion; });
    if (to.empty()) return false;
    video.pace.note(now);
    const MotionGrid grid = motionGrid(*shown.motion, shown.state.viewport);
    const FrameHeader header{.codec = Codec::Motion,
                             .width = grid.columns,
                             .height = grid.rows,
                             .message = shown.messages,
                             .snapshot = shown.number};
    hand(to, motionLane, header, std::make_shared<const std::vector<std::byte>>(packed(grid)), shown.motion);
    return true;
}

FrameHeader Streamer::headerOf(Codec codec, int lane, const studio::Shown& shown,
                               const studio::Picture& picture) const {
    return {.codec = codec,
            .compared = lane == comparedLane,
            .inspected = lane == mainLane && shown.inspected,
            .width = static_cast<uint16_t>(picture.extent.width),
            .height = static_cast<uint16_t>(picture.extent.height),
            .message = shown.messages,
            .snapshot = shown.number};
}

/// The clients that can take something in this lane, and for which the condition holds.
template <typename Condition>
std::vector<Streamer::Recipient> Streamer::recipients(int number, Condition condition) const {
    const std::lock_guard lock(mutex_);
    std::vector<Recipient> result;
    for (const auto& [id, client] : clients_) {
        const Lane& lane = client.lanes[static_cast<size_t>(number)];
        if (client.starts > 0 && !lane.waiting && lane.inFlight < maxInFlight && condition(client, lane))
            result.push_back({id, client.starts});
    }
    return result;
}

bool Streamer::wantsVideo() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(clients_, [](const auto& entry) { return entry.second.vp9; });
}

/// Those that do not have this picture.
std::vector<Streamer::Recipient> Streamer::ready(int number, bool video,
                                                 const std::shared_ptr<const void>& what) const {
    const bool encodes = videos_[static_cast<size_t>(number)].encoder.has_value();
    return recipients(number, [&](const Client& client, const Lane& lane) {
        const bool takesVideo = client.vp9 && (encodes || !client.jpegFirst);
        return takesVideo == video && lane.last != what;
    });
}

void Streamer::hand(const std::vector<Recipient>& recipients, int number, FrameHeader header,
                    const Bytes& bytes, const std::shared_ptr<const void>& what) {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, starts] : recipients) {
        const auto found = clients_.find(id);
        if (found == clients_.end() || found->second.starts != starts) continue;
        Lane& lane = found->second.lanes[static_cast<size_t>(number)];
        lane.waiting = Packet{header, bytes, Clock::now()};
        lane.last = what;
        lane.joins = lane.joins && header.codec == Codec::Jpeg;
        lane.still = header.lossless;
        if (header.codec == Codec::Vp9) lane.synced = true;
    }
}

/// Whether these clients are to get a key frame now. If those that need one have to wait, they are removed.
bool Streamer::mayForceKey(int number, std::vector<Recipient>& recipients, Clock::time_point now) {
    Video& video = videos_[static_cast<size_t>(number)];
    const std::lock_guard lock(mutex_);
    double between = -1.0;
    const auto needsKey = [&](const Recipient& recipient) {
        const auto found = clients_.find(recipient.id);
        if (found == clients_.end()) return true;
        const Lane& lane = found->second.lanes[static_cast<size_t>(number)];
        if (lane.synced) return false;
        const double own = lane.joins ? betweenKeysForNewcomers : betweenKeys;
        between = between < 0.0 ? own : std::min(between, own);
        return true;
    };
    std::vector<Recipient> others;
    std::ranges::remove_copy_if(recipients, std::back_inserter(others), needsKey);
    if (between < 0.0) return false;
    if (secondsBetween(video.lastKey, now) >= between) return true;
    video.keyDue =
        video.lastKey + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(between));
    recipients = std::move(others);
    return false;
}

/// Of the highest bitrate: that of the slowest.
double Streamer::shareOf(const std::vector<Recipient>& recipients) const {
    const std::lock_guard lock(mutex_);
    double share = 1.0;
    for (const Recipient& recipient : recipients) {
        if (const auto found = clients_.find(recipient.id); found != clients_.end())
            share = std::min(share, found->second.share);
    }
    return share;
}

/// Whether a picture that somebody can take is to be sent now. `seen`: the last one that was asked for.
bool Streamer::isDue(const Pace& pace, std::shared_ptr<const void>& seen,
                     const std::shared_ptr<const void>& what) {
    return pace.isDue(Clock::now(), std::exchange(seen, what) != what);
}

/// The encoder of pictures of this size: it is started if there is none.
VideoEncoder& Streamer::encoderFor(Video& video, const studio::Picture& picture, uint32_t bitsPerSecond) {
    if (!video.encoder) {
        video.encoder.emplace(picture.extent, bitsPerSecond, threadsFor(settings_));
        video.lastKey = {};
    }
    video.encoder->setBitrate(bitsPerSecond);
    return *video.encoder;
}

bool Streamer::encodeVideo(int number, const studio::Shown& shown,
                           const std::shared_ptr<const studio::Picture>& picture) {
    std::vector<Recipient> to = ready(number, true, picture);
    Video& video = videos_[static_cast<size_t>(number)];
    const auto now = Clock::now();
    const double seconds = secondsBetween(video.lastFrame, now);
    if (to.empty() || !isDue(video.pace, video.paced, picture)) return false;
    if (video.encoder && video.encoder->extent() != picture->extent) video.encoder.reset();
    const bool key = !video.encoder || mayForceKey(number, to, now);
    if (to.empty()) return false;
    const double highest =
        highestBitsPerPixel * framesASecond * picture->extent.width * picture->extent.height;
    const auto bits =
        static_cast<uint32_t>(std::clamp(shareOf(to) * highest, double{lowestBitrate}, highestBitrate));
    VideoEncoder::Frame frame = encoderFor(video, *picture, bits).encode(*picture, key, seconds);
    video.lastFrame = now;
    video.pace.note(now);
    note(Stage::Convert, frame.convertMilliseconds);
    note(Stage::Encode, frame.encodeMilliseconds);
    if (frame.bytes.empty())
        return false;  // the rate control has dropped it: the next one continues the last
    if (frame.key) video.lastKey = now;
    {
        // Who does not get this frame cannot decode the next one.
        const std::lock_guard lock(mutex_);
        for (auto& [id, client] : clients_) client.lanes[static_cast<size_t>(number)].synced = false;
    }
    FrameHeader header = headerOf(Codec::Vp9, number, shown, *picture);
    header.key = frame.key;
    hand(to, number, header, std::make_shared<const std::vector<std::byte>>(std::move(frame.bytes)), picture);
    return true;
}

bool Streamer::encodeJpegs(int number, const studio::Shown& shown,
                           const std::shared_ptr<const studio::Picture>& picture) {
    const std::vector<Recipient> to = ready(number, false, picture);
    Video& video = videos_[static_cast<size_t>(number)];
    if (to.empty() || !isDue(video.jpegPace, video.jpegPaced, picture)) return false;
    const auto now = Clock::now();
    video.jpegPace.note(now);
    const int quality = static_cast<int>(std::lround(40.0 + 50.0 * shareOf(to)));
    const auto bytes = std::make_shared<const std::vector<std::byte>>(encodeJpeg(*picture, quality));
    note(Stage::Encode, secondsBetween(now, Clock::now()) * 1e3);
    hand(to, number, headerOf(Codec::Jpeg, number, shown, *picture), bytes, picture);
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
    const auto to = recipients(number, [&](const Client&, const Lane& lane) {
        return lane.inFlight == 0 && !(lane.still && lane.last == picture);
    });
    if (to.empty()) return false;
    FrameHeader header = headerOf(Codec::Png, number, shown, *picture);
    header.lossless = true;
    hand(to, number, header, stillOf(picture), picture);
    return true;
}

bool Streamer::answerStillRequests(const studio::Shown& shown) {
    if (!isFull(shown) || shown.facts.compiling || shown.facts.standsIn) return false;
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
