#include "studio/background/scene_loading.h"

#include <chrono>
#include <utility>

#include "scene/motion/movement.h"

namespace limpid::studio {
namespace {

constexpr double loaded = 0.6;  ///< share of the time until a scene's file is read; trees take the rest

bool isReady(const std::future<LoadedScene>& scene) {
    return scene.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

LoadedScene loadScene(const SceneLoader& load, const SceneLoading::Order& order, const Progress& progress) {
    LoadedScene result{load(order.source, progress.part(0.0, loaded)), {}};
    if (order.clip && !result.scene.rig.clips.empty()) scene::chooseClip(result.scene, *order.clip);
    result.data = scene::buildSceneData(result.scene, progress.part(loaded, 1.0));
    return result;
}

void SceneLoading::begin(Order order) {
    cancel();
    progress_ = Progress::watched();
    scene_ = std::async(std::launch::async,
                        [this, order, progress = progress_] { return loadScene(load_, order, progress); });
    order_ = std::move(order);
}

void SceneLoading::cancel() {
    std::erase_if(cancelled_, isReady);
    if (!order_) return;
    progress_.cancel();
    cancelled_.push_back(std::move(scene_));
    order_.reset();
}

bool SceneLoading::isDone() const {
    return order_ && isReady(scene_);
}

LoadedScene SceneLoading::take() {
    order_.reset();
    return scene_.get();
}

}  // namespace limpid::studio
