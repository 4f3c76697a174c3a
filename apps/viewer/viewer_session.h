// An open window: the scene, the camera and the panel in it, and the loop that draws it. The functions lie in
// files by subject: viewer_scene.cpp, viewer_input.cpp, viewer_frame.cpp, viewer_files.cpp, and
// viewer_session.cpp for the rest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "live_render.h"
#include "networks.h"
#include "playback.h"
#include "renderer/frame/pipeline_store.h"
#include "shader_reload.h"
#include "stage.h"
#include "viewer.h"
#include "viewer/camera/camera_rig.h"
#include "viewer/camera/controls.h"
#include "viewer/camera/fly_camera.h"
#include "viewer/camera/picker.h"
#include "viewer/compare/display.h"
#include "viewer/compare/live_comparison.h"
#include "viewer/panel/panel.h"
#include "window.h"

namespace limpid::viewer {

class Viewer {
  public:
    Viewer(const gpu::DeviceOptions& options, TracerChoice tracer, SceneLoader load, scene::Scene first,
           const scene::Camera& home, const ViewSettings& settings);
    void run();
    void storePipelines() const { limpid::storePipelines(device_, pipelineFile(device_)); }
    uint64_t rendered() const { return main_.frames(); }
    ViewSettings settingsNow() const;
    /// The state that another viewer needs to continue with the same scene.
    struct Standing {
        PanelState panel;
        scene::Camera home;
        FlyCamera hand;
        std::string clip;  ///< argument for chooseClip(); empty: none plays
        double time;
    };
    Standing standing() const;
    void takeOver(const Standing& standing);

  private:
    void load(const scene::SceneSource& source);
    void show(scene::Scene scene);
    void goTo(const scene::Camera& home);
    enum class Arrival { Named, Dropped };
    void open(const std::string& file, Arrival arrival);
    void applyLightRequests();
    void relight(const scene::SceneSource& source);
    void startAnew();
    void handleInput(double seconds);
    void fly(float seconds);
    void focus();
    void showPose();
    void placeCamera();
    void applyRequests();
    void applySettings();
    void loadNetworks();
    bool reloadShaders();
    void say(const std::string& message);
    bool messageAges();
    CameraParams cameraNow() const;
    bool mustRender(const CameraParams& camera);
    void render(const CameraParams& camera);
    void noteTimes(bool rendered);
    void measureExposure();
    float stopsOf(const Pipeline& pipeline) const;
    void save(const std::filesystem::path& file);
    void copyCommand();
    void savePath();
    void saveLights();
    void writeControls();
    void noteRendering(bool now);
    /// Runs a function that may fail because of the user's input. Shows the error in the window and returns
    /// false if it does.
    template <typename Function>
    bool attempt(const Function& function) {
        try {
            facts_.fault.clear();
            function();
            return true;
        } catch (const Error& fault) {
            facts_.fault = fault.what();
            log::warn("{}", fault.what());
            return false;
        }
    }

    ViewSettings settings_;
    TracerChoice tracer_;
    SceneLoader load_;
    Window window_;
    gpu::Device device_;
    std::unique_ptr<Stage> stage_;
    Display display_;
    CameraRig rig_;
    Playback playback_;
    PanelState panel_;
    PanelFacts facts_;
    Controls controls_;
    std::string controlsText_;  ///< as last written
    ShaderReload reload_;
    LiveRender main_;
    Networks networks_;
    LiveComparison comparison_;
    Picker picker_;
    int scenesShown_ = 0;     ///< number of scenes loaded so far
    float fovOfLast_ = 0.0f;  ///< degrees
    float speed_ = 1.0f;      ///< world units a second
    int ownShrink_ = 0;       ///< shrink if none is chosen
    Clock::time_point lastTimes_{}, lastSources_{}, lastFrame_{};
    bool frameBefore_ = false;
    bool rendering_ = false;  ///< true if this picture or the last one rendered
    Clock::time_point messageSince_{};
};

}  // namespace limpid::viewer
