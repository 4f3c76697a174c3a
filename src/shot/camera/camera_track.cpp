#include "shot/camera/camera_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "base/json_float.h"
#include "base/text/lower_case.h"

namespace limpid::shot {
namespace {

using nlohmann::json;

/// Reads the members of one camera; messages name the file, the frame and the member.
class CameraReader {
  public:
    CameraReader(const std::filesystem::path& file, const std::string& frame, const json& object)
        : file_(file), frame_(frame), object_(object) {
        if (!object.is_object()) fail("is no object");
        for (const auto& [key, value] : object.items())
            if (key != "eye" && key != "forward" && key != "up" && key != "fov_y" &&
                key != "orthographic_height" && key != "shift")
                fail(fmt::format("has the unknown member '{}'", key));
    }

    ShotCamera read() const {
        ShotCamera camera;
        camera.eye = vector("eye");
        camera.forward = vector("forward");
        camera.up = vector("up");
        if (glm::length(glm::cross(camera.forward, camera.up)) < 1e-6f) fail("looks along its 'up'");
        if (const auto height = optionalNumber("orthographic_height")) {
            if (!(*height > 0.0f)) fail("has an 'orthographic_height' that is not above 0");
            camera.orthographicHeight = *height;
        } else {
            const auto degrees = optionalNumber("fov_y");
            if (!degrees || !(*degrees > 0.0f && *degrees < 180.0f))
                fail("needs 'fov_y', an angle between 0 and 180 degrees");
            camera.verticalFov = glm::radians(*degrees);
        }
        if (object_.contains("shift")) {
            const std::vector<float> shift = numbers("shift", 2);
            camera.shift = {shift[0], shift[1]};
        }
        return camera;
    }

  private:
    [[noreturn]] void fail(const std::string& fault) const {
        throw InputError(file_, fmt::format("the camera of frame {} {}", frame_, fault));
    }

    std::vector<float> numbers(const char* key, size_t count) const {
        const auto found = object_.find(key);
        std::vector<float> result;
        if (found != object_.end() && found->is_array())
            for (const json& value : *found)
                if (const auto number = finiteFloat(value)) result.push_back(*number);
        if (result.size() != count || found->size() != count)
            fail(fmt::format("needs '{}', a list of {} numbers", key, count));
        return result;
    }

    vec3 vector(const char* key) const {
        const std::vector<float> values = numbers(key, 3);
        return {values[0], values[1], values[2]};
    }

    std::optional<float> optionalNumber(const char* key) const {
        const auto found = object_.find(key);
        if (found == object_.end() || found->is_null()) return std::nullopt;
        const auto number = finiteFloat(*found);
        if (!number) fail(fmt::format("has a '{}' that is no number or is too large", key));
        return number;
    }

    const std::filesystem::path& file_;
    const std::string& frame_;
    const json& object_;
};

}  // namespace

CameraParams ShotCamera::params(uint32_t width, uint32_t height, float pixelAspect) const {
    const float w = static_cast<float>(width) * pixelAspect;  // in heights of a pixel
    const auto h = static_cast<float>(height);
    const bool orthographic = orthographicHeight > 0.0f;
    const float halfHeight = orthographic ? orthographicHeight / 2.0f : std::tan(verticalFov / 2.0f);
    const vec3 axis = glm::normalize(forward), right = glm::normalize(glm::cross(axis, up));
    CameraParams result{};
    result.right = right * (halfHeight * w / h);
    result.up = glm::cross(right, axis) * halfHeight;
    // The shift's unit is the larger side; right and up reach from the centre to a border.
    const vec2 moved = shift * 2.0f * std::max(w, h) / vec2(w, h);
    const vec3 offset = result.right * moved.x + result.up * moved.y;
    result.origin = orthographic ? eye + offset : eye;
    result.forward = orthographic ? axis : axis + offset;
    result.orthographic = orthographic ? 1u : 0u;
    result.spread = 2.0f * halfHeight / h;
    return result;
}

CameraTrack CameraTrack::read(const std::string& source, const GltfTiming& timing) {
    const size_t sign = std::filesystem::exists(source) ? std::string::npos : source.rfind('#');
    const std::filesystem::path file = source.substr(0, sign);
    const std::string extension = lowerCase(file.extension().string());
    if (extension != ".gltf" && extension != ".glb") return readJson(source);
    return readGltf(file, sign == std::string::npos ? "" : source.substr(sign + 1), timing);
}

CameraTrack CameraTrack::readJson(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = readFile(file, uint64_t{1} << 30);
    const auto* const begin = reinterpret_cast<const char*>(bytes.data());
    const json root = json::parse(begin, begin + bytes.size(), nullptr, false);
    if (root.is_discarded()) throw InputError(file, "is no JSON file");
    if (!root.is_object() || !root.contains("frames") || !root["frames"].is_object())
        throw InputError(file, "has no object 'frames' with a camera for each frame");
    CameraTrack track;
    for (const auto& [key, object] : root["frames"].items()) {
        const ShotCamera camera = CameraReader(file, key, object).read();
        int frame = 0;
        const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), frame);
        if (key == "all") {
            track.all_ = camera;
        } else if (error == std::errc{} && end == key.data() + key.size()) {
            track.frames_[frame] = camera;
        } else {
            throw InputError(file, fmt::format("'{}' is no frame number", key));
        }
    }
    return track;
}

std::optional<ShotCamera> CameraTrack::at(int frame, UpAxis up) const {
    std::optional<ShotCamera> camera = all_;
    if (const auto found = frames_.find(frame); found != frames_.end()) {
        camera = found->second;
    } else if (yIsUp_ && !frames_.empty()) {
        camera = frame < frames_.begin()->first ? frames_.begin()->second : frames_.rbegin()->second;
    }
    if (camera && yIsUp_ && up == UpAxis::Z)
        for (vec3* vector : {&camera->eye, &camera->forward, &camera->up})
            *vector = {vector->x, -vector->z, vector->y};
    return camera;
}

std::vector<int> CameraTrack::lacking(std::span<const int> frames) const {
    std::vector<int> result;
    if (all_) return result;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(result),
                 [&](int frame) { return !frames_.contains(frame); });
    return result;
}

uint64_t CameraTrack::hash() const {
    Hash64 hash;
    const auto add = [&](const ShotCamera& camera) {
        for (const vec3& v : {camera.eye, camera.forward, camera.up, vec3(camera.shift, 0.0f)})
            for (const float value : {v.x, v.y, v.z}) hash.addValue(value);
        hash.addValue(camera.verticalFov);
        hash.addValue(camera.orthographicHeight);
    };
    hash.addValue(yIsUp_ ? 1 : 0);
    if (all_) add(*all_);
    for (const auto& [frame, camera] : frames_) {
        hash.addValue(frame);
        add(camera);
    }
    return hash.value();
}

}  // namespace limpid::shot
