#include "info_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <nlohmann/json.hpp>

#include "base/text/terminal_text.h"
#include "cli/console/json_text.h"
#include "scene/load/scene_source.h"
#include "scene/motion/animation.h"

namespace limpid::cli {
namespace {

using nlohmann::json;

const char* typeOf(const scene::Camera& camera) {
    return camera.orthographic ? "orthographic" : "perspective";
}

const char* typeOf(const scene::PunctualLight& light) {
    switch (light.kind) {
        case scene::PunctualLight::Kind::Point:
            return "point";
        case scene::PunctualLight::Kind::Spot:
            return "spot";
        case scene::PunctualLight::Kind::Directional:
            return "directional";
    }
    return "";
}

size_t emissiveMaterials(const scene::Scene& scene) {
    return static_cast<size_t>(std::ranges::count_if(
        scene.materials, [](const scene::Material& m) { return m.emission != vec3(0.0f); }));
}

/// Lists the cameras by number; --camera takes a number or a name.
json camerasJson(const scene::Scene& scene) {
    json list = json::array();
    for (const scene::Camera& camera : scene.cameras) {
        json entry{{"index", list.size()},
                   {"name", camera.name},
                   {"type", typeOf(camera)},
                   {"animated_node", camera.node != scene::none}};
        if (camera.orthographic) {
            entry["height"] = 2.0f * camera.halfHeight;
        } else {
            entry["fov"] = glm::degrees(camera.verticalFov);
        }
        list.push_back(entry);
    }
    return list;
}

json clipsJson(const scene::Scene& scene) {
    json list = json::array();
    for (const scene::Clip& clip : scene.rig.clips) {
        list.push_back({{"index", list.size()},
                        {"name", clip.name},
                        {"seconds", clip.duration()},
                        {"channels", clip.channels.size()}});
    }
    return list;
}

json lightsJson(const scene::Scene& scene) {
    json list = json::array();
    for (const scene::PunctualLight& light : scene.lights)
        list.push_back({{"index", list.size()}, {"name", light.name}, {"type", typeOf(light)}});
    return list;
}

json countsJson(const scene::Scene& scene) {
    return {{"triangles", scene.triangleCount()},
            {"meshes", scene.meshes.size()},
            {"instances", scene.instances.size()},
            {"materials", scene.materials.size()},
            {"emissive_materials", emissiveMaterials(scene)},
            {"textures", scene.textures.size()}};
}

std::string shown(const std::string& name) {
    return "'" + terminalText(name) + "'";
}

void printText(const scene::Scene& scene) {
    fmt::print(
        "{} triangles, {} meshes in {} instances, {} materials ({} emissive), {} textures, {} lights\n",
        scene.triangleCount(), scene.meshes.size(), scene.instances.size(), scene.materials.size(),
        emissiveMaterials(scene), scene.textures.size(), scene.lights.size());
    fmt::print("\nCameras (--camera NAME or number)\n");
    for (size_t i = 0; i < scene.cameras.size(); ++i) {
        const scene::Camera& camera = scene.cameras[i];
        const std::string size = camera.orthographic
                                     ? fmt::format("{:.3g} high", 2.0f * camera.halfHeight)
                                     : fmt::format("fov {:.1f} degrees", glm::degrees(camera.verticalFov));
        fmt::print("{:>3}  {:<30} {}, {}\n", i, shown(camera.name), typeOf(camera), size);
    }
    if (!scene.lights.empty()) fmt::print("\nLights\n");
    for (size_t i = 0; i < scene.lights.size(); ++i)
        fmt::print("{:>3}  {:<30} {}\n", i, shown(scene.lights[i].name), typeOf(scene.lights[i]));
    if (scene.rig.clips.empty()) return;
    fmt::print("\nAnimations (--animation NAME or number, or all)\n");
    for (size_t i = 0; i < scene.rig.clips.size(); ++i) {
        const scene::Clip& clip = scene.rig.clips[i];
        fmt::print("{:>3}  {:<30} {:.2f} s\n", i, shown(clip.name), clip.duration());
    }
}

}  // namespace

void printSceneInfo(const std::string& name, bool asJson) {
    // Loaded like in every other command, so a scene without a camera gets one.
    const scene::Scene scene = scene::openScene({.scene = name});
    if (!asJson) return printText(scene);
    json object{{"scene", name},
                {"cameras", camerasJson(scene)},
                {"animations", clipsJson(scene)},
                {"lights", lightsJson(scene)}};
    object.update(countsJson(scene));
    fmt::print("{}\n", jsonText(object));
}

}  // namespace limpid::cli
