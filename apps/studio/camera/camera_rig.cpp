#include "studio/camera/camera_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scene/motion/movement.h"

namespace limpid::studio {
namespace {

constexpr double pathSeconds = 10.0;  ///< of the built-in camera paths
constexpr std::array<const char*, 3> pathNames{"orbit", "dolly", "shake"};

/// Returns a free camera that orbits around the middle of the scene, if that lies ahead.
FlyCamera handAt(const Stage& stage, const scene::Camera& start) {
    const scene::BoundingSphere& sphere = stage.sphere();
    const vec3 eye(start.toWorld[3]), ahead = -vec3(start.toWorld[2]);
    return {start, std::max(glm::dot(sphere.center - eye, ahead), 0.25f * sphere.radius)};
}

}  // namespace

std::vector<std::string> cameraNames(const std::vector<scene::Camera>& cameras) {
    std::vector<std::string> names;
    for (size_t i = 0; i < cameras.size(); ++i) {
        const std::string& own = cameras[i].name;
        const auto same = std::ranges::count(cameras, own, &scene::Camera::name);
        if (own.empty())
            names.push_back(fmt::format("camera {}", i));
        else
            names.push_back(same > 1 ? fmt::format("{} ({})", own, i) : own);
    }
    return names;
}

void CameraRig::show(const Stage& stage, const scene::Camera& home) {
    home_ = home;
    nameAll(stage);
    goHome(stage);
}

void CameraRig::nameAll(const Stage& stage) {
    names_ = cameraNames(stage.scene().cameras);
    names_.insert(names_.begin(), "free");
    names_.insert(names_.end(), pathNames.begin(), pathNames.end());
}

void CameraRig::keep(const Stage& stage) {
    const size_t before = names_.size();
    nameAll(stage);
    if (!isFree() && names_.size() != before) goHome(stage);
}

void CameraRig::choose(const Stage& stage, int number) {
    chosen_ = number;
    path_.reset();
    if (static_cast<size_t>(number) > stage.scene().cameras.size())
        path_ = scene::builtinCameraPath(names_[static_cast<size_t>(number)], stage.scene(), home_,
                                         std::max(stage.duration(), pathSeconds));
}

void CameraRig::goHome(const Stage& stage) {
    stand(stage, home_);
}

void CameraRig::stand(const Stage& stage, const scene::Camera& camera) {
    choose(stage, 0);
    fly_ = handAt(stage, camera);
}

bool CameraRig::place(const Stage& stage, double time, const vec3& eye, const vec3& target, const vec3& up) {
    setFree(stage, time);
    return fly_.place(eye, target, up);
}

void CameraRig::setFree(const Stage& stage, double time) {
    if (isFree()) return;
    fly_ = FlyCamera(at(stage, time), fly_.distance());
    chosen_ = 0;
    path_.reset();
}

scene::Camera CameraRig::at(const Stage& stage, double time) const {
    if (isFree()) return fly_.camera();
    if (path_) return path_->at(time);
    return scene::cameraAt(stage.scene(), stage.scene().cameras[static_cast<size_t>(chosen_) - 1], time);
}

scene::CameraKey CameraRig::key() const {
    scene::CameraKey key;
    key.eye = fly_.eye();
    key.target = fly_.eye() + fly_.forward();  // same as in FlyCamera::camera()
    key.up = fly_.up();
    key.verticalFov = fly_.camera().verticalFov;
    return key;
}

double CameraRig::duration(const Stage& stage) const {
    return path_ ? std::max(stage.duration(), pathSeconds) : stage.duration();
}

std::string CameraRig::option(const std::string& start) const {
    if (isFree()) return {};
    if (!path_) return fmt::format("--camera {}", chosen_ - 1);
    return (start.empty() ? "" : start + " ") + "--camera-path " + names_[static_cast<size_t>(chosen_)];
}

}  // namespace limpid::studio
