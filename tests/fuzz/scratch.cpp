#include "scratch.h"

#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "image/io/png/png.h"
#include "scene/device/pack.h"
#include "scene/load/load.h"
#include "scene/model/camera.h"
#include "scene/motion/movement.h"
#include "scene/motion/scene_animator.h"
#include "scene/prepare/prepare.h"

namespace limpid::fuzz {
namespace fs = std::filesystem;

Scratch::Scratch() {
    std::error_code ignored;
    const fs::path memory = "/dev/shm";
    const fs::path place = fs::is_directory(memory, ignored) ? memory : fs::temp_directory_path();
    std::string pattern = (place / "limpid_fuzz.XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw Error("there is no place for temporary files at " + place.string());
    folder_ = pattern;
    image::writePng(folder_ / "a.png", {2, 2, 4, std::vector<uint8_t>(16, 200)});
}

Scratch::~Scratch() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

fs::path Scratch::write(std::string_view name, Bytes content) const {
    const fs::path path = folder_ / name;
    std::ofstream stream(path, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) throw Error("the temporary file " + path.string() + " cannot be written");
    return path;
}

void Scratch::remove(std::string_view name) const {
    std::error_code ignored;
    fs::remove(folder_ / name, ignored);
}

const Scratch& scratch() {
    static const Scratch instance;
    return instance;
}

scene::SceneData pack(const scene::Scene& scene) {
    scene::SceneData data;
    data.features.vertexData = true;
    scene::fillTexels(scene::packMaterials(scene, data), scene, data, {});
    scene::packGeometry(scene, data, {});
    scene::packLights(scene, data);
    return data;
}

namespace {

/// Computes frames of one clip, like `limpid render --animation`.
void play(scene::Scene& scene, size_t clip) {
    scene::chooseClip(scene, std::to_string(clip));
    const scene::SceneData data = pack(scene);
    const scene::SceneAnimator animator(scene, data);
    const double duration = scene.rig.clips[clip].duration();
    double previous = 0.0;
    for (const double time : {0.0, 0.3 * duration, 0.8 * duration, duration + 1.0}) {
        try {
            animator.frame(time, previous);
        } catch (const Error&) {
            // A clip may move vertices out of range, which is detected in that frame.
        }
        for (const scene::Camera& camera : scene.cameras)
            scene::cameraParams(scene::cameraAt(scene, camera, time), 16, 9);
        previous = time;
    }
}

}  // namespace

bool reachesDevice(const fs::path& sceneFile) {
    scene::Scene scene;
    if (!accepts([&] { scene = scene::loadScene(sceneFile); })) return false;
    // From here on nothing may be refused: every scene that the loader accepts must be renderable.
    scene::prepare(scene);
    for (const scene::Camera& camera : scene.cameras) scene::cameraParams(camera, 16, 9);
    pack(scene);
    for (size_t clip = 0; clip < std::min(scene.rig.clips.size(), size_t{4}); ++clip) play(scene, clip);
    return true;
}

Parts splitAtZero(Bytes input) {
    const auto zero = std::find(input.begin(), input.end(), std::byte{0});
    const auto at = static_cast<size_t>(zero - input.begin());
    if (zero == input.end()) return {input, {}, false};
    return {input.first(at), input.subspan(at + 1), true};
}

}  // namespace limpid::fuzz
