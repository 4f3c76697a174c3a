#include "shot/camera/camera_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "renderer/frame/camera_text.h"

namespace limpid::shot {
namespace {

/// A file, and which of its views is meant.
struct Source {
    const image::ExrDocument& file;
    std::string_view view;
};

/// Finds an attribute in the first part that has it and is not of another view.
template <typename Map>
auto find(const Source& source, Map image::ExrPart::*attributes, const char* name)
    -> std::optional<typename Map::mapped_type> {
    for (const image::ExrPart& part : source.file.parts()) {
        if (!part.view.empty() && !source.view.empty() && part.view != source.view) continue;
        const auto found = (part.*attributes).find(name);
        if (found != (part.*attributes).end()) return found->second;
    }
    return std::nullopt;
}

/// True if the matrix of a movement is for column vectors: it has its translation in the last column.
bool isForColumns(const std::array<float, 16>& m) {
    return m[12] == 0.0f && m[13] == 0.0f && m[14] == 0.0f && (m[3] != 0.0f || m[7] != 0.0f || m[11] != 0.0f);
}

/// glm's matrix, which is for column vectors, by columns.
glm::mat4 toGlm(const std::array<float, 16>& m, bool forColumns) {
    glm::mat4 result;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) result[i][j] = m[static_cast<size_t>(4 * i + j)];
    return forColumns ? glm::transpose(result) : result;
}

/// The tangent of half the horizontal angle of view.
std::optional<float> tangentOf(const Source& source, const glm::mat4& worldToCamera, bool forColumns) {
    if (const auto degrees = find(source, &image::ExrPart::numbers, "CameraFov"))
        if (*degrees > 0.0 && *degrees < 180.0)
            return static_cast<float>(std::tan(glm::radians(*degrees) / 2.0));
    for (const char* name : {"worldToScreen", "worldToNDC"}) {
        const auto matrix = find(source, &image::ExrPart::matrices, name);
        if (!matrix) continue;
        const glm::mat4 projection = toGlm(*matrix, forColumns) * glm::inverse(worldToCamera);
        // From -1 to 1 the axis is at 0; from 0 to 1 at one half of w.
        const bool fromZero = std::abs(projection[2][0] / projection[2][3] - 0.5f) < 0.01f;
        const float scale = projection[0][0] / projection[2][3] * (fromZero ? 2.0f : 1.0f);
        if (std::isfinite(scale) && scale > 1e-3f) return 1.0f / scale;
    }
    return std::nullopt;
}

}  // namespace

std::optional<CameraParams> cameraOfAttributes(const image::ExrDocument& file, std::string_view view) {
    const Source source{file, view};
    if (const auto text = find(source, &image::ExrPart::texts, cameraAttribute)) {
        const std::optional<CameraParams> camera = parseCameraText(*text);
        if (!camera)
            throw InputError(file.name(), std::string("'") + cameraAttribute + "' is not a camera: " + *text);
        return camera;
    }
    const auto matrix = find(source, &image::ExrPart::matrices, "worldToCamera");
    if (!matrix) return std::nullopt;
    const bool forColumns = isForColumns(*matrix);
    const glm::mat4 worldToCamera = toGlm(*matrix, forColumns);
    const glm::mat4 toWorld = glm::inverse(worldToCamera);
    const auto tangent = tangentOf(source, worldToCamera, forColumns);
    const auto finite = [](const vec4& v) { return std::isfinite(v.x + v.y + v.z + v.w); };
    if (!tangent || !finite(toWorld[0]) || !finite(toWorld[1]) || !finite(toWorld[2]) || !finite(toWorld[3]))
        return std::nullopt;
    const auto w = static_cast<float>(file.width()), h = static_cast<float>(file.height());
    const float ratio = h / (w * file.pixelAspect());
    CameraParams camera{};
    camera.origin = vec3(toWorld[3]);
    camera.right = glm::normalize(vec3(toWorld[0])) * *tangent;
    camera.up = glm::normalize(vec3(toWorld[1])) * (*tangent * ratio);
    camera.forward = glm::normalize(vec3(toWorld[2]));
    camera.spread = 2.0f * *tangent / w;
    return camera;
}

}  // namespace limpid::shot
