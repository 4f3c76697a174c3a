#include "studio/loop/render_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "scene/lights/light_file.h"
#include "scene/motion/movement.h"

namespace limpid::studio {
namespace {

constexpr double idleSeconds = 1.0;      ///< longest wait for a message
constexpr double waitingSeconds = 0.02;  ///< same, while something is computed beside the frames
constexpr double messageSeconds = 20.0;

/// The others wait for the first scene: they are about what it shows.
bool concernsLoading(const Message& message) {
    using Kind = Request::Kind;
    const Request* const request = std::get_if<Request>(&message.content);
    return request && (request->kind == Kind::Open || request->kind == Kind::OpenDropped ||
                       request->kind == Kind::CancelLoading);
}

}  // namespace

RenderLoop::RenderLoop(const gpu::DeviceOptions& options, const TracerChoice& tracer, const SceneLoader& load,
                       const CameraStart& start, const StudioSettings& settings,
                       const std::optional<SceneLoading::Order>& first, Mailbox& mailbox)
    : settings_(settings),
      tracer_(tracer),
      start_(start),
      mailbox_(mailbox),
      askedDevice_(options.select),
      loading_(load, first),
      device_(options),
      reload_(settings.shaders),
      main_(device_, reload_.replacements()),
      networks_(device_, settings.weights, settings.loadNetworks),
      comparison_(device_, reload_.replacements(), networks_),
      picker_(device_, reload_.replacements()),
      resolution_(device_.isCpu()) {
    loadPipelines(device_, pipelineFile(device_));
    state_.viewport = settings.render.extent;
    state_.render = settings.render;
    withNetworks_ = {settings.render.pipeline.integrator};
    if (settings.preview) state_.setPreview(true);
    if (settings.jitter) state_.jitter = jitterChoice(*settings.jitter, settings.render.pipeline);
    state_.samples = settings.samples;
    state_.maxSamples = static_cast<int>(std::min<uint64_t>(settings.maxSamples, 1 << 20));
    state_.resolution = settings.resolution;
    facts_.device = device_.info().name;
    // Called many times while a CPU computes a frame.
    const auto interrupted = [this] {
        if (!ending_) tendLoading();
        return isUseless();
    };
    main_.setInterruption(interrupted);
    comparison_.setInterruption(interrupted);
    device_.onNewPipelines([this] { tellCompiling(); });
}

void RenderLoop::say(const std::string& message) {
    facts_.message = message;
    facts_.messageIsOld = false;
    messageSince_ = Clock::now();
    changedFacts_ = true;
}

/// Returns true if the message has just expired.
bool RenderLoop::messageAges() {
    if (facts_.messageIsOld || facts_.message.empty() || secondsSince(messageSince_) < messageSeconds)
        return false;
    return facts_.messageIsOld = true;
}

RenderLoop::Standing RenderLoop::standing() const {
    Standing now{.settings = settings_,
                 .state = state_,
                 .home = rig_.home(),
                 .hand = rig_.hand(),
                 .time = playback_.time(),
                 .messages = messages_,
                 .scene = {}};
    if (!stage_) return now;
    now.scene = SceneLoading::Order{.source = settings_.source};
    const std::string clip = scene::clipChoice(stage_->scene());
    if (!clip.empty()) now.scene->clip = clip;
    return now;
}

void RenderLoop::takeOver(const Standing& standing) {
    settings_ = standing.settings;
    settings_.loseDeviceAt = 0;
    messages_ = standing.messages;
    if (!standing.scene) return;
    show(loading_.take());
    goTo(standing.home);
    state_ = standing.state;
    rig_.hand() = standing.hand;
    rig_.choose(*stage_, state_.camera);
    playback_.reset(standing.time);
    measureExposure_ = false;
    facts_.fault = "the device was lost; everything was set up anew";
}

void RenderLoop::run() {
    bool rests = false;
    while (!mailbox_.isClosed() && (settings_.quitAfter == 0 || rendered() < settings_.quitAfter)) {
        // The newest messages are for the next frame, which begins when the device has finished the last one.
        awaitFrame();
        const bool waits =
            comparison_.isScoring() || loading_ || networks_.isLoading() || isNew_ || resolution_.isCoarse();
        handleMessages(!rests ? 0.0 : waits ? waitingSeconds : idleSeconds);
        finishLoading();
        noteActivity();
        changedFacts_ |= reloadShaders();
        changedFacts_ |= messageAges();
        changedFacts_ |= comparison_.hasScored();
        const bool rendered = stage_ && renderWhatIsDue();
        changedFacts_ |= answerProbe();
        const bool computing = rendered || isNew_;
        if (std::exchange(facts_.computing, computing) != computing) changedFacts_ = true;
        facts_.compiling = isNew_;
        rests = !rendered;
        if (rendered || std::exchange(changedFacts_, false)) publish();
    }
    publishWaiting();
    finish();
}

void RenderLoop::handleMessages(double patience) {
    std::deque<Message> messages = std::exchange(held_, {});
    std::ranges::move(mailbox_.take(patience), std::back_inserter(messages));
    for (Message& message : messages) {
        // Others than gestures may take long.
        if (!std::holds_alternative<Gesture>(message.content)) publishWaiting();
        if (loading_.isFirst() && !concernsLoading(message)) {
            dropReplaced(held_, message);
            held_.push_back(std::move(message));
            continue;
        }
        handle(message);
        hasFailed_ = false;
        messages_ = message.number;
        changedFacts_ = true;
    }
}

/// Tells the clients what is being loaded, and how far that is.
void RenderLoop::noteActivity() {
    std::string activity;
    int percent = 0;
    if (loading_) {
        activity = loading_.order().why == SceneLoading::Why::Relit
                       ? "changing the lights"
                       : "loading " + loading_.order().source.scene;
        percent = loading_.percent();
    } else if (networks_.isLoading()) {
        activity = "loading the network";
        percent = networks_.percent();
    }
    if (facts_.activity == activity && facts_.percent == percent) return;
    facts_.activity = activity;
    facts_.percent = percent;
    changedFacts_ = true;
}

/// Does what was asked for last: pictures are not lost because the window was closed.
void RenderLoop::finish() {
    if (loading_.isFirst() && !settings_.screenshot.empty()) showFirst(loading_.take());
    handleMessages(0.0);
    ending_ = true;
    if (stage_ && (!toSave_.empty() || !settings_.screenshot.empty()) && (networks_.isLoading() || isNew_))
        renderWhatIsDue();  // with what was waited for
    if (stage_ && (!toSave_.empty() || !settings_.screenshot.empty())) {
        if (!main_ || resolution_.isCoarse()) {
            state_.resolution = Resolution::Full;
            renderWhatIsDue();
        }
        saveWhatIsAsked();
        if (!settings_.screenshot.empty()) save(settings_.screenshot);
    }
    device_.waitIdle();
    if (device_.validationMessages() > 0)
        throw Error(fmt::format("the validation layer reported {} messages", device_.validationMessages()));
}

/// Tells the clients that a frame begins: until it ends, they hear nothing.
void RenderLoop::announce() {
    facts_.computing = true;
    publish();
}

/// Tells the clients why this frame takes longer.
void RenderLoop::tellCompiling() {
    tellAmid([](Shown& shown) { shown.facts.compiling = true; });
}

/// Changes a part of what the clients have while a frame is under way.
void RenderLoop::tellAmid(const std::function<void(Shown&)>& change) {
    publishWaiting();
    auto shown = std::make_shared<Shown>(*mailbox_.shown());
    shown->number = ++publications_;
    change(*shown);
    mailbox_.publish(std::move(shown));
}

/// Whether the frame that is under way should be given up.
bool RenderLoop::isUseless() {
    if (ending_ || !interruptible_) return false;
    const bool ends = mailbox_.isClosed() && settings_.quitAfter == 0 && settings_.screenshot.empty();
    const bool replaced = loading_ && loading_.isDone();
    return ends || replaced || mailbox_.hasUrgentMail() || networks_.isDone();
}

/// Begins or gives up the loading of scenes without waiting for the end of the frame, and tells the clients
/// how far that is. Scenes that are there are shown after the frame.
void RenderLoop::tendLoading() {
    const bool before = std::exchange(changedFacts_, false);
    for (const Message& message : mailbox_.takeFirst(concernsLoading)) {
        handle(message);
        messages_ = message.number;
        changedFacts_ = true;
    }
    if (loading_ && loading_.hasFailed()) finishLoading();
    noteActivity();
    if (!std::exchange(changedFacts_, before)) return;
    tellAmid([this](Shown& shown) {
        shown.messages = messages_;
        shown.facts.activity = facts_.activity;
        shown.facts.percent = facts_.percent;
        shown.facts.message = facts_.message;
        shown.facts.messageIsOld = facts_.messageIsOld;
        shown.facts.fault = facts_.fault;
    });
}

/// Chooses what the next snapshot shows. The picture of a frame that the device still computes is not among
/// it.
void RenderLoop::choosePictures() {
    LiveRender* const other = comparison_.picture();
    if (!other || !*other)
        compared_.reset();
    else if (!compared_ || std::exchange(comparedOf_, other->version()) != other->version())
        compared_ = other->picture();
    if (!state_.arrows || isNew_)
        motion_.reset();
    else if (!motion_ || std::exchange(motionOf_, main_.frames()) != main_.frames())
        motion_ = std::make_shared<const image::Image>(main_.renderer().motion());
    if (!isNew_) {  // its passes are those of the preview
        inspect();
        explain();
    }
    if (begun_ && main_.underWay() == begun_->copy) return;
    if (picture_ && pictureOf_ == main_.version()) return;
    const auto begin = Clock::now();
    picture_ = main_.picture();
    pictureOf_ = main_.version();
    facts_.downloadMilliseconds = secondsSince(begin) * 1e3;
}

/// Makes the snapshot of what there is now. If its picture is under way, it is published when that is there,
/// and the next frame has begun.
void RenderLoop::publish() {
    publishWaiting();
    auto shown = std::make_shared<Shown>();
    facts_.comparedWith = comparison_.name();
    facts_.scores = comparison_.scores();
    facts_.errors = comparison_.errors();
    facts_.framesEver = rendered();
    facts_.extent = wanted_.extent;
    facts_.files = filesInUse();
    facts_.standsIn = isNew_ || networks_.isLoading();
    if (main_) choosePictures();
    if (picture_) facts_.pictureExtent = picture_->extent;
    const bool isUnderWay = begun_ && main_ && main_.underWay() == begun_->copy;
    shown->number = ++publications_;
    shown->messages = messages_;
    shown->state = state_;
    shown->state.render.extent = wanted_.extent;
    shown->facts = facts_;
    shown->picture = picture_;
    shown->compared = compared_;
    shown->inspected = inspected_;
    shown->reasons = reasonsShown_;
    shown->motion = motion_;
    if (isUnderWay)
        waiting_ = {std::move(shown), begun_->copy};
    else
        mailbox_.publish(std::move(shown));
}

std::vector<std::string> RenderLoop::filesInUse() const {
    std::vector<std::string> files;
    const auto add = [&](const scene::SceneSource& source) {
        for (const std::string& file : {source.scene, source.environment})
            if (!file.empty()) files.push_back(file);
    };
    add(settings_.source);
    if (loading_) add(loading_.order().source);
    return files;
}

/// Publishes the snapshot that waits for its picture, if there is one.
void RenderLoop::publishWaiting() {
    if (!waiting_) return;
    const Waiting now = *std::exchange(waiting_, std::nullopt);
    const auto begin = Clock::now();
    picture_ = now.copy->picture();
    facts_.downloadMilliseconds = secondsSince(begin) * 1e3;
    now.shown->picture = picture_;
    now.shown->facts.pictureExtent = picture_->extent;
    mailbox_.publish(now.shown);
}

/// Downloads the image of a pass that is shown instead of the picture.
void RenderLoop::inspect() {
    if (state_.pass.empty()) {
        inspected_.reset();
        facts_.images.clear();
        inspectedOf_ = {};
        return;
    }
    std::vector<std::pair<std::string, image::Image>> images;
    const auto wanted = std::tuple(main_.frames(), state_.pass, state_.image);
    if (wanted == inspectedOf_) return;
    try {
        images = main_.renderer().dump(state_.pass);
    } catch (const UsageError&) {  // the pass belongs to another integrator or denoiser
        state_.pass.clear();
        return inspect();
    } catch (const gpu::OutOfMemory& fault) {
        facts_.fault = fault.what();
        state_.pass.clear();
        return inspect();
    }
    facts_.images.clear();
    for (const auto& [name, picture] : images) facts_.images.push_back(name);
    state_.image = std::clamp(state_.image, 0, static_cast<int>(images.size()) - 1);
    inspected_ =
        std::make_shared<const image::Image>(std::move(images[static_cast<size_t>(state_.image)].second));
    inspectedOf_ = wanted;
}

/// Downloads why histories were kept or rejected, for the pixels that are inspected.
void RenderLoop::explain() {
    if (state_.pass.empty() || main_.lacksReasons()) {
        reasonsShown_.reset();
    } else if (std::exchange(reasonsOf_, main_.frames()) != main_.frames() || !reasonsShown_) {
        auto reasons = std::make_shared<const HistoryReasons>(main_.renderer().historyReasons());
        reasonsShown_ = reasons->signals.empty() ? nullptr : std::move(reasons);
    }
}

}  // namespace limpid::studio
