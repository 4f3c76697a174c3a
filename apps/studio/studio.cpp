#include "studio/studio.h"

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <thread>

#include "base/log.h"
#include "studio/background/priority.h"
#include "studio/loop/render_loop.h"

namespace limpid::studio {
namespace {

constexpr uint64_t minFramesOfADevice = 30;  ///< a device lost sooner would be lost again

}  // namespace

struct Studio::Impl {
    gpu::DeviceOptions device;
    TracerChoice tracer;
    SceneLoader load;
    CameraStart start;
    StudioSettings settings;
    Mailbox mailbox;
    std::exception_ptr fault;
    std::atomic<bool> ended = false;
    std::thread thread;

    std::unique_ptr<RenderLoop> makeLoop(const StudioSettings& with,
                                         const std::optional<SceneLoading::Order>& first) {
        return std::make_unique<RenderLoop>(device, tracer, load, start, with, first, mailbox);
    }

    /// Sets everything up anew, on another device or on the same one if it is available again, as often as it
    /// is lost.
    void work() {
        auto loop = makeLoop(settings, RenderLoop::firstScene(settings));
        for (;;) {
            try {
                loop->run();
                return loop->storePipelines();
            } catch (const gpu::DeviceLost& lost) {
                if (loop->rendered() < minFramesOfADevice) throw;
                log::error("{}; setting everything up anew", lost.what());
            }
            const RenderLoop::Standing standing = loop->standing();
            loop.reset();
            loop = makeLoop(standing.settings,
                            standing.scene ? standing.scene : RenderLoop::firstScene(standing.settings));
            loop->takeOver(standing);
        }
    }

    void run() {
        lowerPriority();
        try {
            work();
        } catch (...) {
            fault = std::current_exception();
        }
        ended = true;
        // Tells clients that wait for a snapshot.
        mailbox.publish(mailbox.shown());
    }
};

Studio::Studio(gpu::DeviceOptions device, TracerChoice tracer, SceneLoader load, CameraStart start,
               StudioSettings settings)
    : impl_(std::make_unique<Impl>()) {
    impl_->device = std::move(device);
    impl_->tracer = std::move(tracer);
    impl_->load = std::move(load);
    impl_->start = std::move(start);
    impl_->settings = std::move(settings);
    impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

Studio::~Studio() {
    impl_->mailbox.close();
    if (impl_->thread.joinable()) impl_->thread.join();
}

uint64_t Studio::edit(nlohmann::json changes) {
    return impl_->mailbox.post(std::move(changes));
}

uint64_t Studio::steer(const Gesture& gesture) {
    return impl_->mailbox.post(gesture);
}

uint64_t Studio::ask(Request request) {
    return impl_->mailbox.post(std::move(request));
}

std::shared_ptr<const Shown> Studio::shown() const {
    return impl_->mailbox.shown();
}

uint64_t Studio::addListener(std::function<void()> onShown) {
    return impl_->mailbox.addListener(std::move(onShown));
}

void Studio::removeListener(uint64_t listener) {
    impl_->mailbox.removeListener(listener);
}

bool Studio::hasEnded() const {
    return impl_->ended;
}

void Studio::finish() {
    impl_->mailbox.close();
    if (impl_->thread.joinable()) impl_->thread.join();
    if (impl_->fault) std::rethrow_exception(impl_->fault);
}

}  // namespace limpid::studio
