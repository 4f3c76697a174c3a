#include "studio/background/scene_loading.h"

#include <chrono>
#include <utility>

#include "base/log_receiver.h"
#include "scene/motion/movement.h"

namespace limpid::studio {
namespace {

constexpr double loaded = 0.6;  ///< share of the time until a scene's file is read; trees take the rest

}  // namespace

LoadedScene loadScene(const SceneLoader& load, const SceneLoading::Order& order, const Progress& progress) {
    const log::Collector written;
    LoadedScene result{load(order.source, progress.part(0.0, loaded)), {}};
    if (order.clip && !result.scene.rig.clips.empty()) scene::chooseClip(result.scene, *order.clip);
    result.data = scene::buildSceneData(result.scene, progress.part(loaded, 1.0));
    result.notes = written.messages();
    return result;
}

/// No thread works on it.
bool SceneLoading::isReady(const Future& scene) {
    return !scene.valid() || scene.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void SceneLoading::begin(Order order) {
    cancel();
    progress_ = Progress::watched();
    order_ = std::move(order);
    if (isReady(givenUp_)) start();
}

/// Waits for what was given up.
void SceneLoading::start() {
    givenUp_ = {};
    scene_ = std::async(std::launch::async, [this, order = *order_, progress = progress_] {
                 return std::make_shared<LoadedScene>(loadScene(load_, order, progress));
             }).share();
}

void SceneLoading::cancel() {
    if (!order_) return;
    order_.reset();
    progress_.cancel();
    if (scene_.valid()) givenUp_ = std::move(scene_);
}

bool SceneLoading::isDone() {
    if (order_ && !scene_.valid() && isReady(givenUp_)) start();
    return scene_.valid() && isReady(scene_);
}

bool SceneLoading::hasFailed() {
    if (!isDone()) return false;
    try {
        return !scene_.get();
    } catch (...) {  // take() throws it
        return true;
    }
}

LoadedScene SceneLoading::take() {
    if (!scene_.valid()) start();
    order_.reset();
    return std::move(*std::exchange(scene_, {}).get());
}

}  // namespace limpid::studio
