#include "scene/framing/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "scene/framing/framing.h"
#include "scene/gltf/document/gltf_json.h"
#include "scene/load/scene_files.h"
#include "scene/model/camera.h"

namespace limpid::scene {
namespace {

/// All values of a key: eye, target, up, field of view, lens.
using KeyValues = std::array<float, 12>;

KeyValues valuesOf(const CameraKey& k) {
    return {k.eye.x, k.eye.y, k.eye.z, k.target.x,    k.target.y,     k.target.z,
            k.up.x,  k.up.y,  k.up.z,  k.verticalFov, k.lensDiameter, k.focusDistance};
}

/// Returns the derivative of a value by time at key i, from its neighbours in the same shot.
float tangentAt(const std::vector<CameraKey>& keys, size_t i, size_t component) {
    const bool hasBefore = i > 0 && !keys[i].cut;
    const bool hasAfter = i + 1 < keys.size() && !keys[i + 1].cut;
    const size_t a = hasBefore ? i - 1 : i, b = hasAfter ? i + 1 : i;
    if (a == b) return 0.0f;
    const auto seconds = static_cast<float>(keys[b].time - keys[a].time);
    return (valuesOf(keys[b])[component] - valuesOf(keys[a])[component]) / seconds;
}

KeyValues interpolate(const std::vector<CameraKey>& keys, size_t i, double time) {
    const auto seconds = static_cast<float>(keys[i + 1].time - keys[i].time);
    const auto t = static_cast<float>((time - keys[i].time) / seconds);
    const float t2 = t * t, t3 = t2 * t;
    const KeyValues v0 = valuesOf(keys[i]), v1 = valuesOf(keys[i + 1]);
    KeyValues result;
    for (size_t c = 0; c < result.size(); ++c) {
        result[c] = (2 * t3 - 3 * t2 + 1) * v0[c] + seconds * (t3 - 2 * t2 + t) * tangentAt(keys, i, c) +
                    (3 * t2 - 2 * t3) * v1[c] + seconds * (t3 - t2) * tangentAt(keys, i + 1, c);
    }
    return result;
}

vec3 sums(double time, float phase) {
    // Frequencies without a common period, like a hand's.
    const auto wave = [&](double f, float p) {
        return static_cast<float>(std::sin(2.0 * pi * f * time + p));
    };
    return {0.6f * wave(1.1, phase) + 0.4f * wave(2.7, phase + 1.0f),
            0.6f * wave(1.3, phase + 2.0f) + 0.4f * wave(3.1, phase + 3.0f),
            0.6f * wave(0.9, phase + 4.0f) + 0.4f * wave(2.3, phase + 5.0f)};
}

vec3 aroundVertical(const vec3& v, float angle) {
    return vec3(glm::rotate(mat4(1.0f), angle, vec3(0, 1, 0)) * vec4(v, 0.0f));
}

CameraKey keyOf(std::string_view name, const CameraKey& start, double time) {
    CameraKey key = start;
    key.time = time;
    const vec3 view = start.eye - start.target;
    const float distance = glm::length(view);
    if (name == "orbit") {
        key.eye = start.target + aroundVertical(view, static_cast<float>(2.0 * pi * time / 10.0));
        key.up = aroundVertical(start.up, static_cast<float>(2.0 * pi * time / 10.0));
    } else if (name == "dolly") {
        const auto share = static_cast<float>(0.2 * (1.0 - std::cos(2.0 * pi * time / 4.0)));
        key.eye = start.eye - share * view;
    } else {
        // Starts at the camera's own position.
        key.eye += 0.01f * distance * (sums(time, 0.3f) - sums(0.0, 0.3f));
        key.target += 0.02f * distance * (sums(time, 1.7f) - sums(0.0, 1.7f));
    }
    return key;
}

void requireUsable(const gltf::Object& source, const CameraKey& key) {
    const vec3 view = key.target - key.eye;
    const float limit = 1e18f;
    if (!(glm::length(key.eye) < limit && glm::length(key.target) < limit)) source.fail("is too far away");
    if (!(glm::length(view) > 0.0f)) source.fail("its eye is on its target");
    if (!(glm::length(glm::cross(glm::normalize(view), key.up)) > 1e-6f * glm::length(key.up)) ||
        !(glm::length(key.up) > 0.0f)) {
        source.fail("up", "is zero or along the view");
    }
}

/// An unknown key is most likely a misspelt one.
void requireKnownKeys(const gltf::Object& source, std::initializer_list<std::string_view> known) {
    for (const std::string& key : source.keys()) {
        if (std::ranges::find(known, key) == known.end())
            source.fail(fmt::format("has the unknown key '{}'; known are {}", key, fmt::join(known, ", ")));
    }
}

CameraKey readKey(const gltf::Object& source) {
    requireKnownKeys(source,
                     {"time", "eye", "target", "up", "fov", "lens_diameter", "focus_distance", "cut"});
    CameraKey key;
    for (const char* needed : {"time", "eye", "target"}) {
        if (!source.has(needed)) source.fail(fmt::format("has no {}", needed));
    }
    key.time = source.number("time", 0.0);
    key.eye = source.vector("eye", vec3(0.0f));
    key.target = source.vector("target", vec3(0.0f));
    key.up = source.vector("up", vec3(0, 1, 0));
    const float degrees = source.number("fov", 45.0f);
    if (!(degrees > 0.0f && degrees < 180.0f)) source.fail("fov", "is not between 0 and 180 degrees");
    key.verticalFov = glm::radians(degrees);
    key.lensDiameter = source.number("lens_diameter", 0.0f);
    if (!(key.lensDiameter >= 0.0f && key.lensDiameter <= 1e9f))
        source.fail("lens_diameter", "is not from 0 to 1e9");
    key.focusDistance = source.number("focus_distance", 0.0f);
    if (source.has("focus_distance") && !(key.focusDistance > 0.0f && key.focusDistance <= 1e18f))
        source.fail("focus_distance", "is not above 0, or above 1e18");
    key.cut = source.boolean("cut", false);
    requireUsable(source, key);
    return key;
}

}  // namespace

CameraPath::CameraPath(std::string name, std::vector<CameraKey> keys)
    : name_(std::move(name)), keys_(std::move(keys)) {
    if (keys_.empty()) throw Error("a camera path needs a key");
    for (CameraKey& key : keys_) {
        key.up = glm::normalize(key.up);
        if (key.focusDistance == 0.0f) key.focusDistance = glm::distance(key.eye, key.target);
    }
}

Camera CameraPath::at(double time) const {
    const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                        [](double t, const CameraKey& key) { return t < key.time; });
    const size_t next = static_cast<size_t>(after - keys_.begin());
    const size_t i = next == 0 ? 0 : next - 1;
    KeyValues v = valuesOf(keys_[i]);
    if (next > 0 && next < keys_.size() && !keys_[next].cut) v = interpolate(keys_, i, time);
    Camera camera = lookAt({v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}, v[9]);
    camera.name = name_;
    // A curve may swing below its keys.
    camera.lensDiameter = std::max(v[10], 0.0f);
    camera.focusDistance = std::max(v[11], 0.1f * keys_[i].focusDistance);
    return camera;
}

Camera CameraPath::widest() const {
    const auto key = std::ranges::max_element(keys_, {}, &CameraKey::lensDiameter);
    return at(key->time);
}

bool CameraPath::cutBetween(double before, double now) const {
    return std::any_of(keys_.begin(), keys_.end(),
                       [&](const CameraKey& key) { return key.cut && key.time > before && key.time <= now; });
}

CameraPath loadCameraPath(const std::filesystem::path& file) {
    const gltf::Json json = gltf::parseJson(file, readSceneFile(file), "a camera path");
    const gltf::Object root(file, json, "");
    requireKnownKeys(root, {"keys"});
    std::vector<CameraKey> keys;
    for (const gltf::Object& source : root.objects("keys")) {
        keys.push_back(readKey(source));
        if (keys.size() > 1 && !(keys.back().time > keys[keys.size() - 2].time))
            source.fail("time", "is not later than the key's before");
    }
    if (keys.empty()) throw InputError(file, "has no \"keys\"");
    return {file.stem().string(), std::move(keys)};
}

bool isBuiltinCameraPath(std::string_view name) {
    return name == "orbit" || name == "dolly" || name == "shake";
}

CameraPath builtinCameraPath(std::string_view name, const Scene& scene, const Camera& camera,
                             double seconds) {
    CameraKey start;
    start.eye = vec3(camera.toWorld[3]);
    start.up = vec3(camera.toWorld[1]);
    start.verticalFov = camera.orthographic ? 0.8f : camera.verticalFov;
    const vec3 forward = -glm::normalize(vec3(camera.toWorld[2]));
    const auto [center, radius] = boundingSphere(scene);
    start.target = start.eye + forward * std::max(glm::dot(center - start.eye, forward), 0.25f * radius);
    // Dense keys make the interpolation error invisible.
    constexpr double step = 1.0 / 60.0;
    std::vector<CameraKey> keys;
    const auto count = static_cast<size_t>(std::ceil(std::max(seconds, 0.0) / step)) + 2;
    for (size_t i = 0; i < count; ++i) keys.push_back(keyOf(name, start, static_cast<double>(i) * step));
    return {std::string(name), std::move(keys)};
}

}  // namespace limpid::scene
