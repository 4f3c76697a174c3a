// The thread of the renderer: takes the messages of its clients, renders frame after frame, and publishes
// each. The functions lie in files by subject: loop_scene.cpp, loop_requests.cpp, loop_frame.cpp,
// loop_files.cpp, and render_loop.cpp for the rest.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "renderer/frame/pipeline_store.h"
#include "studio/background/networks.h"
#include "studio/background/scene_loading.h"
#include "studio/background/shader_reload.h"
#include "studio/camera/camera_rig.h"
#include "studio/camera/picker.h"
#include "studio/compare/live_comparison.h"
#include "studio/live/live_render.h"
#include "studio/live/playback.h"
#include "studio/live/resolution.h"
#include "studio/live/stage.h"
#include "studio/loop/mailbox.h"
#include "studio/settings.h"
#include "studio/state/command_line.h"

namespace limpid::studio {

class RenderLoop {
  public:
    /// All but the settings and `first` outlive this. `first` is loaded while the device is set up. Throws as
    /// Device does.
    RenderLoop(const gpu::DeviceOptions& options, const TracerChoice& tracer, const SceneLoader& load,
               const CameraStart& start, const StudioSettings& settings,
               const std::optional<SceneLoading::Order>& first, Mailbox& mailbox);
    /// Gives up what is being loaded before it waits for the device.
    ~RenderLoop() { loading_.cancel(); }
    /// The scene that the studio starts with, if it starts with one.
    static std::optional<SceneLoading::Order> firstScene(const StudioSettings& settings);
    /// Until the mailbox is closed, or as many frames were rendered as asked for.
    void run();
    void storePipelines() const { limpid::storePipelines(device_, pipelineFile(device_)); }
    uint64_t rendered() const { return main_.frames(); }

    /// What another loop needs to continue with the same scene, on another device.
    struct Standing {
        StudioSettings settings;
        State state;
        scene::Camera home;
        FlyCamera hand;
        double time = 0.0;
        uint64_t messages = 0;
        std::optional<SceneLoading::Order> scene;  ///< what is shown
    };
    Standing standing() const;
    /// Of a loop that began with the scene of `standing`.
    void takeOver(const Standing& standing);

  private:
    void finish();
    SceneLoading::Order orderToChange() const;
    void finishLoading();
    void show(LoadedScene scene);
    void showFirst(LoadedScene scene);
    void showOpened(LoadedScene scene, const SceneLoading::Order& order);
    void showRelit(LoadedScene scene, const SceneLoading::Order& order);
    void goTo(const scene::Camera& home);
    void open(const std::string& file, bool dropped);
    void addLamp(bool sun);
    void takeLampAway(int index);
    void changeBackground();
    LightDesk deskWithout(std::vector<int> lamps) const;
    void startAnew();

    void handleMessages(double patience);
    void handle(const Message& message);
    void edit(const nlohmann::json& changes);
    void steer(const Gesture& gesture);
    void freeCamera();
    void carryOut(const Request& request);
    void resetCamera();
    void seeAll();
    void focus(const std::array<float, 2>& position);
    void showPose();
    void placeCamera();
    void applySettings();
    void provideNetworks();
    void finishNetworks();
    void doWithoutNetworks();
    void cancelLoading();
    void noteActivity();

    bool reloadShaders();
    void say(const std::string& message);
    bool messageAges();
    CameraParams cameraAt(double time) const;
    CameraParams cameraNow() const { return cameraAt(playback_.time()); }
    Shutter blur() const;
    bool isOther(const CameraParams& camera) const;
    bool mustRender();
    bool renderWhatIsDue();
    bool renderNext();
    bool goBack(const std::string& fault);
    bool previewsFirst();
    void renderTimed(const CameraParams& camera);
    void render(const CameraParams& camera);
    void renderSharp(const CameraParams& camera);
    void renderBlurred(const CameraParams& camera);
    bool overlaps() const;
    void awaitFrame();
    void noteFrameTime(bool rendered);
    void measureExposure();
    float stopsOf(const Pipeline& pipeline) const;
    image::ToneCurve curveOf(const Pipeline& pipeline) const;
    Look lookOf(const Pipeline& pipeline) const;
    std::string probeAll(const std::array<float, 2>& position);
    void inspect();
    void choosePictures();
    bool wantsReasons() const { return !state_.pass.empty() || probeAt_; }
    void explain();
    void probe(const std::array<float, 2>& position);
    bool answerProbe();
    void publish();
    void publishWaiting();
    std::vector<std::string> filesInUse() const;
    void announce();
    void tellCompiling();
    void tellAmid(const std::function<void(Shown&)>& change);
    bool isUseless();
    void tendLoading();

    void saveWhatIsAsked();
    void save(const std::filesystem::path& file);
    void makeCommand();
    void makeStateCommand(const ShownFrame& frame, const CommandLine& command);
    void giveCommand(const std::string& text, const std::string& message);
    void savePath();
    void saveLights();

    /// Runs a function that may fail because of the user's input. Keeps the error for the user and returns
    /// false if it does.
    template <typename Function>
    bool attempt(const Function& function) {
        try {
            facts_.fault.clear();
            function();
            return true;
        } catch (const gpu::DeviceLost&) {
            throw;
        } catch (const Error& fault) {
            facts_.fault = fault.what();
            log::warn("{}", fault.what());
            return false;
        }
    }

    StudioSettings settings_;
    const TracerChoice& tracer_;
    const CameraStart& start_;
    Mailbox& mailbox_;
    std::string askedDevice_;  ///< DeviceOptions::select
    SceneLoading loading_;     ///< before the device, which takes as long to set up as a small scene to load
    gpu::Device device_;
    std::unique_ptr<Stage> stage_;  ///< null: no scene yet
    CameraRig rig_;
    Playback playback_;
    Playback flight_;  ///< the same, but it goes on where the resolution changes
    State state_;
    RenderSettings wanted_;  ///< state_.render with what follows from other fields, and networks
    Facts facts_;
    ShaderReload reload_;
    LiveRender main_;
    Networks networks_;
    Pipeline withNetworks_;  ///< the last one that was not waiting for its network
    LiveComparison comparison_;
    Picker picker_;
    /// The scene is new: until the pipelines of its first frame are compiled, its preview is shown.
    bool isNew_ = false;
    std::future<void> compiling_;    ///< them
    std::optional<State> rendered_;  ///< of the last frame of this scene that was rendered as wanted
    bool hasFailed_ = false;         ///< the next frame would, too: none is rendered until something changes
    ResolutionControl resolution_;
    std::tuple<Pipeline, uint32_t, bool, int> work_;  ///< what decides how long a pixel takes
    Clock::time_point changed_{};                     ///< when something that is seen has changed last
    uint64_t messages_ = 0;                           ///< number of the last one that was handled
    uint64_t publications_ = 0;
    bool changedFacts_ = true;  ///< something is to be published, though no frame was rendered
    /// The frame is a long one of a picture that rests. Those of a moving one are short, and are all
    /// finished: else a hand that moves on would never see one.
    bool interruptible_ = false;
    bool ending_ = false;
    bool step_ = false, measureExposure_ = false;
    std::optional<std::array<float, 2>> probeAt_;  ///< a probe that waits for a frame with reasons
    std::vector<std::string> toSave_;              ///< extensions of pictures that were asked for
    float fovOfLast_ = 0.0f;                       ///< degrees
    Shutter blurOfLast_;
    size_t pipelinesBefore_ = 0;  ///< when the last frame had been computed
    bool other_ = false;          ///< isOther(), for the next frame
    float speed_ = 1.0f;          ///< of flying, world units a second
    Clock::time_point lastTimes_{}, lastSources_{}, lastFrame_{};
    bool frameBefore_ = false;
    Clock::time_point messageSince_{};

    std::deque<Message> held_;  ///< messages that wait for the first scene

    /// A frame that the device computes.
    struct Begun {
        std::shared_ptr<PictureCopy> copy;
        Clock::time_point when;
        size_t pipelines = 0;  ///< of the device before it
    };
    std::optional<Begun> begun_;
    /// A snapshot whose picture is on its way to the host.
    struct Waiting {
        std::shared_ptr<Shown> shown;
        std::shared_ptr<PictureCopy> copy;
    };
    std::optional<Waiting> waiting_;

    // The pictures that were published last.
    uint64_t pictureOf_ = 0, comparedOf_ = 0, motionOf_ = 0, reasonsOf_ = 0;
    float exposureOf_ = 0.0f;
    std::shared_ptr<const Picture> picture_, compared_;
    std::shared_ptr<const image::Image> inspected_, motion_;
    std::shared_ptr<const HistoryReasons> reasonsShown_;
    std::tuple<uint64_t, std::string, int> inspectedOf_;
};

}  // namespace limpid::studio
