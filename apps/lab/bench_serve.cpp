// `limpid bench serve`: frames per second and latency of the window in a browser, without the browser: a
// client in this process connects over the loopback interface, decodes the stream and steers the camera.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/clock.h"
#include "base/error.h"
#include "cli/options/studio_options.h"
#include "lab/bench.h"
#ifdef LIMPID_HAVE_SERVE
#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

#include "serve/remote/remote_socket.h"
#include "serve/remote/video_decoder.h"
#include "serve/serve.h"
#include "serve/session/protocol.h"
#include "studio/studio.h"
#endif

namespace limpid::cli {
namespace {

struct ServeBench {
    StudioChoice studio;
    std::string codec = "vp9";
    double seconds = 10.0;
    uint32_t steps = 30;
    uint32_t threads = 0;
};

#ifdef LIMPID_HAVE_SERVE
using nlohmann::json;
constexpr double patience = 300.0;           ///< seconds for a scene to load, and for a frame
constexpr double gestureSeconds = 1.0 / 60;  ///< between two gestures of a hand

/// A browser that only decodes.
class BenchViewer {
  public:
    BenchViewer(int port, const std::string& token, const std::string& codec) : session_(port, token) {
        say({{"type", "start"}, {"codecs", codec == "vp9" ? json{"vp9", "jpeg"} : json{"jpeg"}}});
    }

    void steer() {
        ++steers_;
        // Alternates between left and right, so that the scene stays in view.
        const double turn = steers_ / 32 % 2 == 0 ? 0.01 : -0.01;
        say({{"type", "steer"}, {"orbit", {turn, 0.0}}, {"id", steers_}});
    }
    /// Takes in what arrives, at most that long. True: it was a picture.
    bool receive(double seconds) {
        const auto message = session_.receive(seconds);
        if (!message) return false;
        if (message->kind == serve::RemoteMessage::Kind::Closed)
            throw Error("the server has closed the session");
        if (message->kind == serve::RemoteMessage::Kind::Text) {
            const json text = json::parse(message->bytes);
            if (text["type"] == "ack") numbers_[text["id"]] = text["message"];
            return false;
        }
        const auto bytes = std::as_bytes(std::span(message->bytes));
        const serve::FrameHeader header = serve::unpackedHeader(bytes);
        if (header.codec == serve::Codec::Vp9) {
            const auto begin = Clock::now();
            decoder_.decode(bytes.subspan(serve::frameHeaderBytes));
            decoding_.push_back(secondsSince(begin) * 1e3);
        }
        say({{"type", "received"}, {"frame", header.frame}});
        newest_ = header.message;
        extent_ = {header.width, header.height};
        bytes_ += message->bytes.size();
        return true;
    }
    /// Whether a picture has arrived that includes the last gesture.
    bool hasFollowed() const {
        const auto found = numbers_.find(steers_);
        return found != numbers_.end() && newest_ >= found->second;
    }
    void forgetBytes() { bytes_ = 0; }
    size_t bytes() const { return bytes_; }
    /// Milliseconds, of each picture so far.
    const std::vector<double>& decoding() const { return decoding_; }
    gpu::Extent extent() const { return extent_; }

  private:
    void say(const json& message) { session_.sendText(message.dump()); }

    serve::RemoteSession session_;
    serve::VideoDecoder decoder_;
    std::map<uint64_t, uint64_t> numbers_;  ///< of messages, by the client's
    uint64_t steers_ = 0, newest_ = 0;
    size_t bytes_ = 0;
    std::vector<double> decoding_;
    gpu::Extent extent_;
};

/// How long frames take in each stage, milliseconds, while it collects.
class StageTimes {
  public:
    /// The studio outlives this.
    explicit StageTimes(studio::Studio& studio) : studio_(studio) {
        listener_ = studio_.addListener([this] { noteFrame(); });
    }
    ~StageTimes() { studio_.removeListener(listener_); }
    StageTimes(const StageTimes&) = delete;
    StageTimes& operator=(const StageTimes&) = delete;

    void collect(bool collects) { collects_ = collects; }
    /// On any thread.
    void add(const std::string& stage, double milliseconds) {
        if (!collects_) return;
        const std::lock_guard lock(mutex_);
        times_[stage].push_back(milliseconds);
    }
    std::vector<double> of(const std::string& stage) const {
        const std::lock_guard lock(mutex_);
        const auto found = times_.find(stage);
        return found == times_.end() ? std::vector<double>() : found->second;
    }

  private:
    void noteFrame() {
        const auto shown = studio_.shown();
        const studio::Facts& facts = shown->facts;
        if (std::exchange(frames_, facts.framesEver) == facts.framesEver) return;
        add("render", facts.renderMilliseconds);
        add("download", facts.downloadMilliseconds);
    }

    studio::Studio& studio_;
    uint64_t listener_ = 0, frames_ = 0;
    std::atomic<bool> collects_ = false;
    mutable std::mutex mutex_;
    std::map<std::string, std::vector<double>> times_;
};

const char* nameOf(serve::Stage stage) {
    constexpr std::array names{"convert", "encode", "send"};
    return names.at(static_cast<size_t>(stage));
}

/// Milliseconds from a gesture to the first decoded picture that includes it, when nothing else moves the
/// camera.
std::vector<double> latencies(BenchViewer& viewer, uint32_t steps) {
    std::vector<double> times;
    for (uint32_t i = 0; i < steps; ++i) {
        const auto start = Clock::now();
        viewer.steer();
        while (!viewer.hasFollowed()) {
            viewer.receive(1.0);
            if (secondsSince(start) > patience) throw Error("no picture follows the camera");
        }
        times.push_back(secondsSince(start) * 1e3);
    }
    std::ranges::sort(times);
    return times;
}

/// Pictures per second while a hand moves the camera all the time.
double rate(BenchViewer& viewer, double seconds) {
    viewer.forgetBytes();
    const auto start = Clock::now();
    double next = 0.0;
    uint64_t pictures = 0;
    for (double now = 0.0; now < seconds; now = secondsSince(start)) {
        if (now >= next) {
            viewer.steer();
            next = now + gestureSeconds;
        }
        pictures += viewer.receive(std::max(next - now, 0.001));
    }
    return static_cast<double>(pictures) / secondsSince(start);
}

/// The medians, in the order in which a picture passes the stages.
void printStages(const StageTimes& times, const BenchViewer& viewer, double seconds) {
    std::string text;
    const auto add = [&](const char* stage, const std::vector<double>& values) {
        if (!values.empty())
            text += fmt::format("{}{} {:.2f} ms", text.empty() ? "" : ", ", stage, median(values));
    };
    for (const char* stage : {"render", "download", "convert", "encode", "send"}) add(stage, times.of(stage));
    add("decode", viewer.decoding());
    fmt::print("stages: {} (medians); {:.1f} frames/s were rendered\n", text,
               static_cast<double>(times.of("render").size()) / seconds);
}

void measure(const ServeBench& o, const std::string& url, Clock::time_point begin, StageTimes& stages) {
    const size_t colon = url.rfind(':'), equals = url.rfind('=');
    BenchViewer viewer(std::stoi(url.substr(colon + 1)), url.substr(equals + 1), o.codec);
    const auto start = Clock::now();
    while (!viewer.receive(1.0)) {
        if (secondsSince(start) > patience) throw Error("no picture comes");
    }
    const double first = secondsSince(begin);
    latencies(viewer, 3);  // pipelines are made, the encoder is warm
    const std::vector<double> times = latencies(viewer, o.steps);
    stages.collect(true);
    const double pictures = rate(viewer, o.seconds);
    stages.collect(false);
    fmt::print("{} of {} x {} ({})\n", o.studio.scene.source.scene, viewer.extent().width,
               viewer.extent().height, o.codec);
    fmt::print("first picture: {:.2f} s after the start\n", first);
    fmt::print("latency: {:.1f} ms median, {:.1f} ms of 95 %, {:.1f} ms at most ({} gestures)\n",
               median(times), times[(times.size() - 1) * 95 / 100], times.back(), times.size());
    fmt::print("rate: {:.1f} frames/s, {:.2f} Mbit/s ({} s)\n", pictures,
               static_cast<double>(viewer.bytes()) * 8e-6 / o.seconds, o.seconds);
    printStages(stages, viewer, o.seconds);
}

void run(const ServeBench& o) {
    const auto begin = Clock::now();
    studio::StudioSettings settings;
    apply(o.studio, settings);
    studio::Studio studio(o.studio.device.device, tracerChoice(o.studio), sceneLoader(),
                          cameraStart(o.studio), settings);
    StageTimes stages(studio);
    serve::ServeSettings serving;
    serving.stream.encoderThreads = o.threads;
    serving.stream.timed = [&](serve::Stage stage, double milliseconds) {
        stages.add(nameOf(stage), milliseconds);
    };
    std::promise<std::string> address;
    std::atomic<bool> ends = false;
    auto server = std::async(std::launch::async, [&] {
        try {
            serve::serve(
                studio, serving, [&] { return ends || studio.hasEnded(); },
                [&](const std::string& url) { address.set_value(url); });
        } catch (...) {
            address.set_exception(std::current_exception());
        }
    });
    std::exception_ptr fault;
    try {
        measure(o, address.get_future().get(), begin, stages);
    } catch (...) {
        fault = std::current_exception();
    }
    ends = true;
    server.get();
    studio.finish();  // what ended the renderer tells more
    if (fault) std::rethrow_exception(fault);
}
#else
void run(const ServeBench&) {
    throw Error(
        "Limpid was built without libwebsockets-dev and libvpx-dev: there is no 'limpid serve' to measure");
}
#endif

}  // namespace

void addServeBench(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand(
        "serve", "Frames per second and latency of 'limpid serve', measured by a client on the same machine");
    auto o = std::make_shared<ServeBench>();
    addStudioOptions(*command, o->studio);
    command->add_option("--codec", o->codec, "vp9 or jpeg (vp9)")->check(CLI::IsMember({"vp9", "jpeg"}));
    command->add_option("--seconds", o->seconds, "For the frames per second (10)")
        ->check(CLI::Range(0.1, 3600.0));
    command->add_option("--steps", o->steps, "Gestures for the latency (30)")->check(CLI::Range(1, 100000));
    command
        ->add_option("--threads", o->threads, "Of the video encoder (three quarters of the cores, up to 16)")
        ->check(CLI::Range(1, 64));
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
