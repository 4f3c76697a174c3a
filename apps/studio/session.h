// How a user interface talks to the renderer, which runs on a thread of its own: edits and requests go in,
// immutable snapshots come out. No call waits for a frame.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "renderer/frame/history_reasons.h"
#include "studio/camera/gesture.h"
#include "studio/picture.h"
#include "studio/state/facts.h"
#include "studio/state/state.h"

namespace limpid::studio {

/// What a frame left behind.
struct Shown {
    uint64_t number = 0;    ///< counts the snapshots
    uint64_t messages = 0;  ///< number of the last message that it includes
    State state;
    Facts facts;
    std::shared_ptr<const Picture> picture, compared;  ///< null: there is none
    std::shared_ptr<const image::Image> inspected;     ///< the image of State::pass; null: none is inspected
    /// With State::pass, if the denoiser keeps histories: why it kept or rejected those of each pixel.
    std::shared_ptr<const HistoryReasons> reasons;
    std::shared_ptr<const image::Image> motion;  ///< with State::arrows; null: the pipeline has none
};

/// Things to do once. Positions are from 0 to 1 in the picture, from its upper left corner.
struct Request {
    enum class Kind {
        Reset,  ///< the next frame is the first one: histories and means are new
        Step,   ///< one frame, also while rendering is stopped
        MeasureExposure,
        ResetCamera,
        SeeAll,       ///< moves the camera to where everything is seen
        Focus,        ///< turns the camera to what is seen at `position`
        Probe,        ///< fills Facts::allValues with what the passes have at `position`; again: empties it
        Open,         ///< a scene or an environment: `file`
        OpenDropped,  ///< the same, but it may not read files outside of its folder
        CancelLoading,
        AddPoint,
        AddSun,
        RemoveLamp,  ///< the added lamp `index`
        SaveLights,  ///< writes lights.json
        SavePath,    ///< writes flown.json
        SavePng,     ///< writes limpid.png or limpid-N.png in the working folder, at the full resolution
        SaveExr,
        KeepSettings,  ///< the settings become those of the comparison with `kept settings`
        CommandLine,   ///< fills Facts::command
        Extended,      ///< StudioSettings::extended from now on: `index` is 1, or 0
    } kind = Kind::Reset;
    std::string file = {};
    int index = 0;
    std::array<float, 2> position{};
};

class Session {
  public:
    virtual ~Session() = default;

    /// Changes fields of the state: a JSON object with keys of studio/state/state_json.h. Invalid values
    /// change nothing and are reported in Facts::fault. Returns the message's number, for Shown::messages.
    virtual uint64_t edit(nlohmann::json changes) = 0;
    /// Moves the camera. Gestures that arrive during a frame are added up: none is queued behind another.
    virtual uint64_t steer(const Gesture& gesture) = 0;
    virtual uint64_t ask(Request request) = 0;

    /// The newest snapshot; never null.
    virtual std::shared_ptr<const Shown> shown() const = 0;
    /// Calls the function on another thread after each new snapshot. It must return soon. Several may be
    /// added; the result removes it, and is a number for removeListener().
    virtual uint64_t addListener(std::function<void()> onShown) = 0;
    virtual void removeListener(uint64_t listener) = 0;
};

}  // namespace limpid::studio
