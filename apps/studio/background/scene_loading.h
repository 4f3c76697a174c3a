// A scene that is being read and built on a thread of its own, while another one is shown. At most one is
// read at a time: what is asked for meanwhile waits, and only the last of it.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "scene/device/scene_data.h"
#include "scene/load/scene_source.h"

namespace limpid::studio {

/// Returns a complete scene (scene/prepare/prepare.h). Throws InputError, UsageError and Cancelled.
using SceneLoader = std::function<scene::Scene(const scene::SceneSource& source, const Progress& progress)>;

struct LoadedScene {
    scene::Scene scene;
    scene::SceneData data;
    std::vector<std::string> notes = {};  ///< what its loading wrote: what was added or left out
};

class SceneLoading {
  public:
    enum class Why { First, Opened, Relit };  ///< Relit: the same scene with other lights
    struct Order {
        scene::SceneSource source;
        Why why = Why::Opened;
        std::optional<std::string>
            clip;             ///< argument for chooseClip(), if the scene has clips; none: no clip
        std::string message;  ///< for the user, when it is done
        /// Lamps of the shown scene that `source` has no more: numbers among those that were added.
        std::vector<int> gone;
    };

    /// `load` outlives this. Begins with `first`, if there is one.
    explicit SceneLoading(const SceneLoader& load, std::optional<Order> first = {}) : load_(load) {
        if (first) begin(std::move(*first));
    }
    /// Gives up what is being loaded.
    ~SceneLoading() { cancel(); }
    SceneLoading(const SceneLoading&) = delete;
    SceneLoading& operator=(const SceneLoading&) = delete;

    /// Begins, once what was being loaded has been given up.
    void begin(Order order);
    /// Nothing waits for what is given up but the next order: its thread ends at its next step.
    void cancel();
    explicit operator bool() const { return order_.has_value(); }
    const Order& order() const { return *order_; }
    bool isFirst() const { return order_ && order_->why == Why::First; }
    /// To be asked again and again: begins what had to wait.
    bool isDone();
    /// Whether it is done, and take() would throw.
    bool hasFailed();
    int percent() const { return static_cast<int>(100.0 * progress_.done()); }
    /// Waits for the scene and returns it. Throws what the loader threw, and Error. Nothing is being loaded
    /// afterwards.
    LoadedScene take();

  private:
    void start();

    const SceneLoader& load_;
    std::optional<Order> order_;
    Progress progress_;
    /// Shared, because hasFailed() looks into it.
    using Future = std::shared_future<std::shared_ptr<LoadedScene>>;
    static bool isReady(const Future& scene);

    Future scene_;    ///< of the order; none while that waits
    Future givenUp_;  ///< its thread may still run; none while there is a scene_
};

/// Loads a scene, starts its clip and builds its trees and tables. Throws what the loader throws, Error and
/// Cancelled.
LoadedScene loadScene(const SceneLoader& load, const SceneLoading::Order& order, const Progress& progress);

}  // namespace limpid::studio
