#include "cli/options/scene_options.h"

#include "base/error.h"
#include "cli/console/help_text.h"
#include "scene/builtin/builtin.h"
#include "scene/model/camera.h"

namespace limpid::cli {

namespace {

/// Squares of coordinates must stay within the range of a float.
constexpr double farthest = 1e18;

}  // namespace

void addSceneOptions(CLI::App& command, SceneChoice& choice, bool required) {
    const OptionGroup group(command, "Scene and camera");
    std::string builtins;
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) builtins += " builtin:" + info.name;
    command
        .add_option(
            "SCENE", choice.source.scene,
            "A .gltf, .glb or .obj file, or one of" + builtins + " builtin:room-N builtin:still-life-N")
        ->required(required);
    command.add_option("--env", choice.source.environment,
                       "Environment map: .hdr or .exr, latitude-longitude");
    command
        .add_option("--light", choice.source.lights,
                    "Add a white light: point,X,Y,Z,INTENSITY, or sun,X,Y,Z,INTENSITY shining in that "
                    "direction (repeatable)")
        ->allow_extra_args(false);
    command.add_option("--lights", choice.source.lightFile,
                       "Changes to the scene's lights, as saved by the window (JSON)");
    command.add_option(
        "--background", choice.source.background,
        "Constant radiance from all directions instead of an environment: R,G,B; 0,0,0 is black");
    command.add_option("--camera", choice.camera, "Camera by name or number; default: the first");
    const CLI::Range reachable(-farthest, farthest);
    command.add_option("--eye", choice.eye, "Position of your own camera: X,Y,Z; needs --target")
        ->delimiter(',')
        ->expected(3)
        ->check(reachable);
    command.add_option("--target", choice.target, "Point that your own camera looks at: X,Y,Z")
        ->delimiter(',')
        ->expected(3)
        ->check(reachable);
    command.add_option("--up", choice.up, "Up direction of your own camera: X,Y,Z (0,1,0)")
        ->delimiter(',')
        ->expected(3)
        ->check(reachable);
    command
        .add_option("--fov", choice.fov,
                    "Vertical field of view of your own camera, degrees; more shows more")
        ->check(CLI::Range(0.01, 179.0));
    command.add_option("--asset-root", choice.source.assetRoot,
                       "Folder that the scene may read textures, buffers and materials from, besides its "
                       "own; default: the folder above, unless that is / or contains home folders");
    command
        .add_option("--max-image-memory", choice.source.maxImageMemory,
                    "Maximum host memory of one texture or environment map, as in 512MB or 8GB (2GB); larger "
                    "ones are scaled down")
        ->transform(CLI::AsSizeValue(false))
        ->check(CLI::Range(uint64_t{1} << 20, uint64_t{1} << 50));
}

scene::Camera chosenCamera(const scene::Scene& scene, const SceneChoice& choice) {
    scene::Camera camera = scene::findCamera(scene, choice.camera);
    if (choice.eye.empty() && choice.target.empty() && choice.up.empty() && choice.fov == 0.0f) return camera;
    if (choice.eye.size() != 3 || choice.target.size() != 3)
        throw UsageError("--eye and --target go together, three numbers each; --fov and --up go with them");
    const vec3 eye(choice.eye[0], choice.eye[1], choice.eye[2]),
        target(choice.target[0], choice.target[1], choice.target[2]);
    if (eye == target) throw UsageError("--eye and --target are the same point");
    const vec3 up =
        choice.up.empty() ? vec3(0.0f, 1.0f, 0.0f) : vec3(choice.up[0], choice.up[1], choice.up[2]);
    const bool isFlat = glm::length(up) > 0.0f && glm::length(glm::cross(target - eye, up)) > 0.0f;
    if (!choice.up.empty() && !isFlat) throw UsageError("--up is zero or along the view");
    return scene::lookAt(eye, target, up, choice.fov > 0.0f ? glm::radians(choice.fov) : camera.verticalFov);
}

}  // namespace limpid::cli
