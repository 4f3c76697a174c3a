#include "scene/gltf/rig/gltf_camera.h"

#include <algorithm>
#include <cmath>

#include "scene/model/camera.h"

namespace limpid::scene::gltf {
namespace {

float positive(const Object& owner, const char* key) {
    const float value = owner.number(key, 0.0f);
    if (!(value > 0.0f)) owner.fail(key, "is not positive");
    return value;
}

void readPerspective(const Object& source, Camera& camera) {
    const auto perspective = source.object("perspective");
    if (!perspective) source.fail("has no perspective");
    camera.verticalFov = positive(*perspective, "yfov");
    if (camera.verticalFov >= pi) perspective->fail("yfov", "is not below 180 degrees");
    if (perspective->has("aspectRatio")) camera.aspect = positive(*perspective, "aspectRatio");
}

void readOrthographic(const Object& source, Camera& camera) {
    const auto orthographic = source.object("orthographic");
    if (!orthographic) source.fail("has no orthographic");
    camera.orthographic = true;
    // Negative magnifications are discouraged but allowed; only their size matters.
    camera.halfHeight = std::abs(orthographic->number("ymag", 0.0f));
    const float halfWidth = std::abs(orthographic->number("xmag", 0.0f));
    if (camera.halfHeight == 0.0f || halfWidth == 0.0f) orthographic->fail("its view has no size");
    camera.aspect = halfWidth / camera.halfHeight;
    if (!std::isfinite(camera.aspect) || camera.aspect <= 0.0f) camera.aspect = 0.0f;
}

void readCones(Document& document, const Object& source, PunctualLight& light) {
    const auto spot = source.object("spot");
    if (!spot) source.fail("is a spot light without spot");
    light.innerCone = spot->number("innerConeAngle", 0.0f);
    light.outerCone = spot->number("outerConeAngle", pi / 4);
    if (light.innerCone >= 0.0f && light.innerCone < light.outerCone && light.outerCone <= pi / 2) return;
    document.warn(spot->place() + ": cone angles out of range, clamped");
    light.outerCone = std::clamp(light.outerCone, 1e-3f, pi / 2);
    light.innerCone = std::clamp(light.innerCone, 0.0f, light.outerCone * 0.999f);
}

}  // namespace

Camera readCamera(const Object& source, const mat4& toWorld, const std::string& nodeName) {
    Camera camera;
    camera.name = source.text("name", nodeName);
    camera.toWorld = withoutScale(toWorld);
    const std::string type = source.text("type");
    if (type == "perspective") {
        readPerspective(source, camera);
    } else if (type == "orthographic") {
        readOrthographic(source, camera);
    } else {
        source.fail("type", "is neither perspective nor orthographic");
    }
    return camera;
}

PunctualLight readLight(Document& document, const Object& source, const mat4& toWorld,
                        const std::string& nodeName) {
    PunctualLight light;
    light.name = source.text("name", nodeName);
    light.position = vec3(toWorld[3]);
    light.direction = -vec3(withoutScale(toWorld)[2]);
    const vec3 color = glm::max(source.vector("color", vec3(1.0f)), vec3(0.0f));
    const float intensity = source.number("intensity", 1.0f);
    if (intensity < 0.0f) document.warn(source.place() + ".intensity is negative and taken as 0");
    light.intensity = glm::min(color * std::max(intensity, 0.0f), vec3(1e30f));
    light.range = std::max(source.number("range", 0.0f), 0.0f);
    const std::string type = source.text("type");
    if (type == "spot") {
        light.kind = PunctualLight::Kind::Spot;
        readCones(document, source, light);
    } else if (type == "directional") {
        light.kind = PunctualLight::Kind::Directional;
    } else if (type != "point") {
        source.fail("type", "is '" + type.substr(0, 20) + "', not point, spot or directional");
    }
    return light;
}

}  // namespace limpid::scene::gltf
