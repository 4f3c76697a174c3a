// A studio and its server over many frames, with all that happens to them: other sizes, scenes and methods,
// edits and camera moves, clients that come, go and vanish. Memory must stay flat, on the host and on the
// device, and the validation layers must say nothing (they are on with LIMPID_VALIDATION=1; Studio::finish()
// throws then).
//
// It runs only with LIMPID_SOAK_FRAMES, the number of frames: 100000 take hours on a CPU.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <random>
#include <span>
#include <thread>
#include <vector>

#include "gpu/specialise/specialise.h"
#include "scene/load/scene_source.h"
#include "serve/remote/remote_socket.h"
#include "serve/session/protocol.h"
#include "serve/web/web_server.h"
#include "studio/studio.h"

namespace limpid::serve {
namespace {

using studio::Request;

constexpr const char* token = "soak";
constexpr std::array scenes{"builtin:cornell", "builtin:lab-mirror", "builtin:cornell-moving",
                            "builtin:lab-textures"};
constexpr std::array denoisers{"svgf", "atrous", "temporal", "none", "bilateral"};
constexpr std::array networks{"nano", "film"};

uint64_t wantedFrames() {
    const char* const text = std::getenv("LIMPID_SOAK_FRAMES");
    return text ? std::strtoull(text, nullptr, 10) : 0;
}

/// Resident memory of this process, in MB.
double residentMegabytes() {
    uint64_t all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

class Mean {
  public:
    void add(double value) {
        sum_ += value;
        ++count_;
    }
    double value() const { return count_ == 0 ? 0.0 : sum_ / count_; }

  private:
    double sum_ = 0.0, count_ = 0.0;
};

/// A client of the server, for a while.
class Visitor {
  public:
    Visitor(int port, std::mt19937& random) : session_(port, token), endsBadly_(random() % 2 == 0) {
        constexpr std::array codecs{R"(["vp9"])", R"(["jpeg"])", R"(["vp9","jpeg"])"};
        session_.sendText(
            fmt::format(R"({{"type":"start","codecs":{}}})", codecs.at(random() % codecs.size())));
    }
    ~Visitor() {
        // Half a message, and the connection is cut.
        if (endsBadly_) session_.sendFrame(0x01, R"({"type":"ed)");
    }
    /// Takes and acknowledges what has arrived; counts the pictures.
    uint64_t look() {
        uint64_t pictures = 0;
        while (const auto message = session_.receive(0.0)) {
            if (message->kind == RemoteMessage::Kind::Closed) break;
            if (message->kind != RemoteMessage::Kind::Picture) continue;
            ++pictures;
            const FrameHeader header = unpackedHeader(std::as_bytes(std::span(message->bytes)));
            session_.sendText(fmt::format(R"({{"type":"received","frame":{}}})", header.frame));
        }
        return pictures;
    }

  private:
    RemoteSession session_;
    bool endsBadly_;
};

class Soak : public testing::Test {
  protected:
    void SetUp() override {
        if (gpu::enumerateDevices().empty()) GTEST_SKIP() << "NOT TESTED: this machine has no Vulkan device.";
        if (wantedFrames() == 0) GTEST_SKIP() << "NOT TESTED: LIMPID_SOAK_FRAMES is not set.";
        studio::StudioSettings settings;
        settings.source.scene = scenes[0];
        settings.render.extent = {32, 24};
        settings.resolution = studio::Resolution::Full;
        const char* const device = std::getenv("LIMPID_TEST_DEVICE");
        studio_ = std::make_unique<studio::Studio>(
            gpu::DeviceOptions{.select = device ? device : "cpu", .specialise = gpu::specialiser()},
            [](const gpu::Device&) { return scene::Tracer::Compute; }, scene::openScene,
            [](const scene::Scene& scene) { return scene.cameras.front(); }, settings);
        server_ = std::make_unique<WebServer>(*studio_, ServeSettings{}, files_, token);
        serving_ = std::thread([this] { server_->run([this] { return ends_.load(); }); });
    }
    void TearDown() override {
        ends_ = true;
        if (serving_.joinable()) serving_.join();
        server_.reset();
    }

    /// Something that a user may do.
    void disturb() {
        switch (random_() % 12) {
            case 0:
                studio_->ask({.kind = Request::Kind::Open, .file = scenes[random_() % scenes.size()]});
                break;
            case 1:
            case 2:
                // Networks take several times as long as the others on a CPU.
                studio_->edit({{"denoiser", random_() % 24 == 0 ? networks[random_() % networks.size()]
                                                                : denoisers[random_() % denoisers.size()]}});
                break;
            case 3:
            case 4:
                studio_->edit({{"viewport", {16 + random_() % 32, 12 + random_() % 24}}});
                break;
            case 5:
                studio_->edit({{"compare", random_() % 2 == 0 ? "nothing" : "atrous"}});
                break;
            case 6:
                studio_->edit({{"playing", random_() % 2 == 0}, {"arrows", random_() % 2 == 0}});
                break;
            case 7:
                if (random_() % 2 == 0) studio_->ask({.kind = Request::Kind::AddPoint});
                break;
            case 8:
                studio_->ask({.kind = Request::Kind::RemoveLamp, .index = 0});
                break;
            case 9:
                studio_->ask({.kind = Request::Kind::CancelLoading});
                break;
            case 10:
                studio_->edit({{"pass", random_() % 2 == 0 ? "" : "pathtrace"}});
                break;
            default:
                studio_->ask({.kind = Request::Kind::Probe, .position = {0.5f, 0.5f}});
        }
        studio_->edit({{"seed", random_() % 1000}});  // the picture never rests
    }

    /// Clients come and go; returns the pictures that they got.
    uint64_t visit() {
        if (visitors_.size() < 4 && random_() % 4 == 0)
            visitors_.push_back(std::make_unique<Visitor>(server_->port(), random_));
        if (!visitors_.empty() && random_() % 8 == 0)
            visitors_.erase(visitors_.begin() + static_cast<ptrdiff_t>(random_() % visitors_.size()));
        uint64_t pictures = 0;
        for (const auto& visitor : visitors_) pictures += visitor->look();
        return pictures;
    }

    std::mt19937 random_{1};
    SceneFiles files_{{}};
    std::unique_ptr<studio::Studio> studio_;
    std::unique_ptr<WebServer> server_;
    std::atomic<bool> ends_ = false;
    std::thread serving_;
    std::vector<std::unique_ptr<Visitor>> visitors_;
};

TEST_F(Soak, MemoryStaysFlat) {
    const uint64_t frames = wantedFrames();
    uint64_t pictures = 0, reported = 0, scenesShown = 0;
    double hostThen = 0.0, hostNow = 0.0;
    Mean deviceThen, deviceNow;
    uint64_t disturbedAt = 0;
    for (uint64_t done = 0; done < frames && !studio_->hasEnded();) {
        // Not by time: the first frames wait for shaders to be compiled.
        if (done == 0 || done >= disturbedAt + 5) {
            disturbedAt = done;
            disturb();
        }
        pictures += visit();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        const auto shown = studio_->shown();
        done = shown->facts.framesEver;
        scenesShown = std::max<uint64_t>(scenesShown, static_cast<uint64_t>(shown->facts.scenesShown));
        hostNow = std::max(hostNow, residentMegabytes());
        deviceNow.add(static_cast<double>(shown->facts.memoryBytes) / 1e6);
        if (done * 10 / frames == reported) continue;
        // The first half and the second half are compared: the largest memory of the host, and the mean of
        // the device, whose largest depends on rare combinations of size and method.
        reported = done * 10 / frames;
        std::fprintf(
            stderr,
            "%llu frames, %llu scenes, %llu pictures sent: host %.0f MB at most, device %.2f MB on average\n",
            static_cast<unsigned long long>(done), static_cast<unsigned long long>(scenesShown),
            static_cast<unsigned long long>(pictures), hostNow, deviceNow.value());
        if (reported == 5) {
            hostThen = std::exchange(hostNow, 0.0);
            deviceThen = std::exchange(deviceNow, {});
        }
    }
    visitors_.clear();
    EXPECT_FALSE(studio_->hasEnded());
    EXPECT_GT(pictures, frames / 100);
    EXPECT_GT(scenesShown, frames / 500);
    EXPECT_LT(hostNow, 1.1 * hostThen + 8.0);
    EXPECT_LT(deviceNow.value(), 1.1 * deviceThen.value());
    studio_->finish();
}

}  // namespace
}  // namespace limpid::serve
