// What the studio tells of itself: nothing of it can be changed. Clients in other processes get what toJson()
// of state_json.h has of it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "studio/state/timings.h"

namespace limpid::studio {

struct Facts {
    std::string device;
    std::string scene;    ///< name of the scene; empty: there is none
    int scenesShown = 0;  ///< number of scenes that were loaded so far
    /// What was added to the scene or left out when it was loaded, such as "the scene has no camera: ...".
    std::vector<std::string> notes;
    /// What takes longer than a frame now, such as "loading helmet.glb"; empty: nothing.
    std::string activity;
    /// Scenes and environments that are shown or being loaded, as they were asked for. They may be read
    /// again.
    std::vector<std::string> files;
    int percent = 0;             ///< how much of it is done; 0: too little, or it is not known
    gpu::Extent extent;          ///< of the frame that is computed, or was last
    gpu::Extent pictureExtent;   ///< of the picture that is shown: fewer pixels while something moves
    uint64_t samplesInMean = 0;  ///< per pixel; 0 for pipelines that do not accumulate
    uint64_t frames = 0;         ///< since the last reset
    uint64_t framesEver = 0;
    uint64_t framesBegun = 0;  ///< more than were finished: some are given up
    bool computing = false;    ///< false: the picture is finished, or rendering is stopped
    bool compiling = false;    ///< the frame that is computed needs shaders that were not compiled before
    /// The picture is that of a simpler method, until pipelines are compiled or a network is loaded.
    bool standsIn = false;
    double duration = 0.0;  ///< of the clip or the path, seconds; 0: nothing plays
    std::vector<std::string> cameras;
    Timings timings;
    /// Of the last frame: until the device had finished it, and to bring its picture to the host after that.
    double renderMilliseconds = 0.0, downloadMilliseconds = 0.0;
    uint64_t memoryBytes = 0, sceneBytes = 0;  ///< on the device
    float sceneRadius = 1.0f;                  ///< world units
    std::string comparedWith, scores;
    Track errors;  ///< FLIP of the picture against what it is compared with, each time that it was measured
    std::string allValues;            ///< result of the last probe
    std::array<float, 2> probedAt{};  ///< its position in the picture; only where there is a result
    std::vector<std::string> images;  ///< of State::pass
    std::string message;              ///< the last thing that was done
    bool messageIsOld = false;        ///< it need not be shown any more
    std::string fault;                ///< the last thing that failed
    std::string command;              ///< the command line that was asked for last
    uint64_t commands = 0;            ///< counts them

    /// "loading helmet.glb, 40 %"; empty: nothing takes long.
    std::string activityText() const;
};

}  // namespace limpid::studio
