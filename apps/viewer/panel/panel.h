// The panel beside the picture: what is rendered, how, and how long it takes.
#pragma once

#include <string>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "renderer/frame/settings.h"
#include "viewer/camera/controls.h"
#include "viewer/compare/comparison.h"
#include "viewer/compare/inspector.h"
#include "viewer/panel/light_desk.h"
#include "viewer/panel/timings.h"

namespace limpid::viewer {

/// Asked for; whoever does it clears it.
struct PanelRequests {
    bool measureExposure = false, resetCamera = false, screenshot = false, exr = false, command = false,
         savePath = false;
    bool reset = false;       ///< start anew: histories, means, the frame's number
    bool step = false;        ///< one frame, though rendering stands still
    bool seek = false;        ///< to PanelState::time
    bool choosePose = false;  ///< PanelState::camera is another one
    bool place = false;       ///< PanelState::pose is another one
    bool open = false;        ///< PanelState::file
    bool relight = false;     ///< the background of PanelState::lights is another one
    bool addPoint = false, addSun = false, saveLights = false;
    int removeLamp = -1;  ///< this added light
    bool probe = false;   ///< all values under the mouse
    bool seeAll = false;  ///< a camera from where everything is seen
};

/// Of the camera, whichever it is.
struct CameraPose {
    vec3 eye{0.0f}, target{0.0f}, up{0.0f, 1.0f, 0.0f};
};

/// What the panel shows and changes.
/// PanelState::jitter for this one.
int jitterChoice(Jitter jitter, const Pipeline& pipeline);

struct PanelState {
    RenderSettings render;  ///< its extent and jitter follow from what is below
    uint32_t samples = 1;   ///< per pixel and frame
    int maxSamples = 4096;  ///< of pictures that accumulate
    int jitter = 0;         ///< 0: as the pipeline needs it; else 1 + Jitter
    int shrink = 0;         ///< 2^shrink pixels of the window for one of the picture's, along each axis
    float exposure = 0.0f;  ///< stops
    float fovDegrees = 45.0f;
    CameraPose pose;
    bool holdsPose = false;  ///< a control is held or typed into: `pose` is what it says
    bool running = true;     ///< frames are rendered as long as there is something to gain
    bool playing = false;    ///< the clip, or the camera's path
    float time = 0.0f;       ///< seconds
    int camera = 0;          ///< of PanelFacts::cameras
    std::string file;        ///< scene or environment to open
    std::string pass;        ///< whose images are shown instead of the picture; empty: none
    int image = 0;           ///< of PanelFacts::images
    InspectorView view;
    ComparisonChoice comparison;
    float divider = 0.65f;   ///< of the window's width: what it is compared with lies right of it
    bool magnifier = false;  ///< beside the mouse
    bool arrows = false;     ///< of motion
    LightDesk lights;
    bool shown = true;
    PanelRequests asked;

    bool isPreview() const { return render.pipeline.integrator == Integrator::Preview; }
    /// The integrator `preview`, or what was before it.
    void setPreview(bool on) {
        if (on == isPreview()) return;
        if (on) pipelineBefore = render.pipeline;
        render.pipeline = on ? Pipeline{Integrator::Preview} : pipelineBefore;
    }
    Pipeline pipelineBefore;  ///< `preview`
};

/// What it only shows.
struct PanelFacts {
    std::string device;
    uint64_t samplesInMean = 0;  ///< 0 where nothing accumulates
    uint64_t frames = 0;         ///< since the last reset
    double duration = 0.0;       ///< of the clip or of the path, seconds; 0: nothing plays
    std::vector<std::string> cameras;
    Timings timings;
    uint64_t memoryBytes = 0, sceneBytes = 0;  ///< of the device
    float sceneRadius = 1.0f;                  ///< world units
    std::string comparedWith, scores;
    std::string allValues;            ///< of the last probe
    std::vector<std::string> images;  ///< of PanelState::pass
    std::string probe;                ///< what lies under the mouse in the image that is shown
    std::string message;              ///< of the last thing that was done
    bool messageIsOld = false;        ///< and no longer shown
    std::string fault;                ///< of the last thing that failed
};

/// ImGui's calls for it.
void drawPanel(PanelState& state, const PanelFacts& facts, Controls& controls);

}  // namespace limpid::viewer
