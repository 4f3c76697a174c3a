#include "renderer/frame/camera_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace limpid {
namespace {

std::string text(const vec3& v) {
    return fmt::format("{} {} {}", v.x, v.y, v.z);  // the shortest text that gives the same float
}

/// Splits the text into words.
class Words {
  public:
    explicit Words(std::string_view text) : rest_(text) {}

    bool take(std::string_view word) { return next() == word; }
    bool take(float& value) {
        const std::string_view word = next();
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        return error == std::errc{} && end == word.data() + word.size() && std::isfinite(value);
    }
    bool take(vec3& v) { return take(v.x) && take(v.y) && take(v.z); }
    bool empty() const { return rest_.empty(); }

  private:
    std::string_view next() {
        const size_t end = std::min(rest_.find(' '), rest_.size());
        const std::string_view word = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        return word;
    }
    std::string_view rest_;
};

}  // namespace

std::string cameraText(const CameraParams& camera) {
    return fmt::format("{} origin {} forward {} right {} up {} spread {}",
                       camera.orthographic != 0 ? "orthographic" : "perspective", text(camera.origin),
                       text(camera.forward), text(camera.right), text(camera.up), camera.spread);
}

std::optional<CameraParams> parseCameraText(std::string_view description) {
    CameraParams camera{};
    camera.orthographic = description.starts_with("orthographic ") ? 1 : 0;
    Words words(description);
    const bool complete = words.take(camera.orthographic != 0 ? "orthographic" : "perspective") &&
                          words.take("origin") && words.take(camera.origin) && words.take("forward") &&
                          words.take(camera.forward) && words.take("right") && words.take(camera.right) &&
                          words.take("up") && words.take(camera.up) && words.take("spread") &&
                          words.take(camera.spread) && words.empty();
    return complete ? std::optional(camera) : std::nullopt;
}

std::string jitterText(vec2 jitter) {
    return fmt::format("{} {}", jitter.x, jitter.y);
}

std::optional<vec2> parseJitterText(std::string_view description) {
    vec2 jitter(0.0f);
    Words words(description);
    const bool complete = words.take(jitter.x) && words.take(jitter.y) && words.empty();
    if (!complete || std::abs(jitter.x) > 0.5f || std::abs(jitter.y) > 0.5f) return std::nullopt;
    return jitter;
}

}  // namespace limpid
