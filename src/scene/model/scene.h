// A scene on the CPU, made by loaders or built in: meshes, instances, materials, textures, lights, cameras.
// World: right-handed, +Y up, metres; cameras look along -Z (glTF). Colours: linear, Rec. 709.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "scene/motion/animation.h"
#include "scene/motion/deformation.h"

namespace limpid::scene {

inline constexpr int none = -1;

/// Triangles in object space. Optional attribute arrays are empty or as long as `positions`.
struct Mesh {
    std::string name;
    std::vector<vec3> positions;
    std::vector<vec3> normals;  ///< unit; empty: flat shading
    std::vector<vec4>
        tangents;  ///< xyz unit, w = +-1 (bitangent = w cross(n, t)); empty if no normal map needs it
    std::vector<vec2> uv0, uv1;
    std::vector<vec4> colors;       ///< linear RGBA
    std::vector<uint32_t> indices;  ///< three per triangle, all below positions.size()
    std::vector<uint16_t>
        materialSlots;  ///< one per triangle, added to the instance's material; empty: all 0
    /// Set if a clip may move the vertices; positions, normals and tangents above are then those at rest.
    std::shared_ptr<const Deformation> deformation;

    size_t triangleCount() const { return indices.size() / 3; }
};

enum class Wrap : uint8_t { Repeat, ClampToEdge, MirroredRepeat };
enum class MipFilter : uint8_t { None, Nearest, Linear };

struct Sampler {
    Wrap wrapU = Wrap::Repeat;
    Wrap wrapV = Wrap::Repeat;
    bool magLinear = true;
    bool minLinear = true;
    MipFilter mip = MipFilter::Linear;
    bool operator==(const Sampler&) const = default;
};

/// 8-bit RGBA texels, row 0 at the top (v = 0). `srgb`: RGB hold sRGB-encoded values.
struct Texture {
    std::string name;
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgba;
    bool srgb = false;
    Sampler sampler;
};

/// A reference to a texture: its index, the coordinate set, and KHR_texture_transform as a 2x3 matrix on (u,
/// v, 1).
struct TextureRef {
    int texture = none;
    int uvSet = 0;  ///< 0 or 1
    vec3 rowU{1, 0, 0};
    vec3 rowV{0, 1, 0};
    explicit operator bool() const { return texture != none; }
};

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// glTF metallic-roughness. Defaults are glTF's.
struct Material {
    std::string name;
    vec4 baseColor{1.0f};
    float metallic = 1.0f;
    float roughness = 1.0f;    ///< perceptual; GGX alpha = roughness^2
    float specular = 1.0f;     ///< weight of the dielectric's specular lobe; 0: Lambertian
    vec3 specularColor{1.0f};  ///< factor of its reflectance at normal incidence
    float ior = 1.5f;
    float transmission = 0.0f;
    bool thin = true;  ///< transmission without refraction (no volume); false: a closed body that refracts
    vec3 absorption{0.0f};   ///< inside a closed body, per metre in world space (Beer's law)
    float clearcoat = 0.0f;  ///< weight of a dielectric layer of index 1.5 over everything else, including
                             ///< emission
    float clearcoatRoughness = 0.0f;  ///< perceptual
    float clearcoatNormalScale = 1.0f;
    float anisotropy = 0.0f;              ///< strength: how much rougher one direction is
    float anisotropyRotation = 0.0f;      ///< of that direction from the tangent, radians, counter-clockwise
    vec3 sheenColor{0.0f};                ///< of light that fibres scatter, over all but the coat
    float sheenRoughness = 0.0f;          ///< perceptual
    float diffuseTransmission = 0.0f;     ///< share of the diffuse light that goes to the other side
    vec3 diffuseTransmissionColor{1.0f};  ///< its colour, instead of baseColor
    float dispersion = 0.0f;              ///< 20 / Abbe number of a refracting body
    float iridescence = 0.0f;             ///< weight of a thin film over metal and dielectric
    float iridescenceIor = 1.3f;          ///< of the film
    float iridescenceThicknessMin = 100.0f, iridescenceThicknessMax = 400.0f;  ///< of the film, nanometres
    vec3 emission{0.0f};        ///< radiance, including its strength
    bool staysEmitter = false;  ///< its triangles remain lights even while it emits nothing
    float normalScale = 1.0f;
    float occlusionStrength =
        1.0f;  ///< kept for completeness: a path tracer computes occlusion and ignores it
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
    bool unlit = false;  ///< baseColor is emitted unchanged, nothing is reflected
    TextureRef baseColorTexture, metallicRoughnessTexture, normalTexture, occlusionTexture, emissionTexture,
        transmissionTexture;
    TextureRef specularTexture;       ///< alpha: factor of `specular`
    TextureRef specularColorTexture;  ///< RGB: factor of `specularColor`
    TextureRef
        anisotropyTexture;  ///< RG: direction in tangent space, from -1 to 1; B: factor of `anisotropy`
    TextureRef sheenColorTexture, sheenRoughnessTexture;                     ///< RGB, A
    TextureRef diffuseTransmissionTexture, diffuseTransmissionColorTexture;  ///< A, RGB
    TextureRef iridescenceTexture, iridescenceThicknessTexture;  ///< R; G: from minimum to maximum
    TextureRef clearcoatTexture, clearcoatRoughnessTexture, clearcoatNormalTexture;  ///< R, G, RGB
};

/// True if the material's triangles are lights. Those of an unlit material are not, whatever it emits.
inline bool isEmitter(const Material& material) {
    return !material.unlit && (material.staysEmitter || material.emission != vec3(0.0f));
}

/// How an instance may change from frame to frame. Follows from the chosen clip (scene/motion/movement.h).
enum class Movement : uint8_t { Still, Rigid, Deforming };

/// A mesh placed in the world. Meshes that share geometry are one Mesh with several instances.
struct Instance {
    int mesh = 0;
    int material = 0;      ///< for slot 0
    mat4 transform{1.0f};  ///< at rest; the identity for a skinned mesh, whose vertices are in world space
    std::string name;
    int node = none;  ///< of the rig: moves the instance and holds its morph weights
    int skin = none;  ///< of the rig
    Movement movement = Movement::Still;
};

/// KHR_lights_punctual: point and spot intensity in candela, directional in lux (radiance unit: cd/m^2).
struct PunctualLight {
    enum class Kind { Point, Spot, Directional } kind = Kind::Point;
    vec3 position{0.0f};
    vec3 direction{0.0f, 0.0f, -1.0f};  ///< unit; the direction in which the light travels
    vec3 intensity{1.0f};               ///< colour times intensity
    float range = 0.0f;                 ///< metres; 0: unlimited
    float innerCone = 0.0f;             ///< radians, half angles
    float outerCone = pi / 4;
    std::string name;
    int node = none;  ///< of the rig
};

/// A latitude-longitude picture around the scene: row 0 is +Y, the centre column looks along -Z (see
/// scene/lights/environment.h).
struct Environment {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<vec3> radiance;
    vec3 scale{1.0f};   ///< multiplies the radiance
    float turn = 0.0f;  ///< rotation about +Y as a fraction of a full circle: what was at u is at u + turn
    bool empty() const { return radiance.empty(); }
};

struct Camera {
    std::string name;
    mat4 toWorld{1.0f};  ///< rigid: no scale
    bool orthographic = false;
    float verticalFov = 0.8f;  ///< radians, perspective
    float halfHeight = 1.0f;   ///< world units, orthographic
    float aspect = 0.0f;       ///< the author's width / height; 0: that of the picture
    /// Of a thin lens, world units; 0: a pinhole. Perspective only.
    float lensDiameter = 0.0f;
    float focusDistance = 0.0f;  ///< from the camera along its view to the plane in focus; 0: unknown
    int node = none;             ///< of the rig
};

struct Scene {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    std::vector<Material> materials;  ///< never empty
    std::vector<Texture> textures;
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;  ///< not empty after prepare() (scene/prepare/prepare.h)
    Environment environment;
    Rig rig;
    int clip = none;  ///< index into rig.clips of the clip that plays
    /// That it was loaded from, the scene file first; empty if it is built in.
    std::vector<std::filesystem::path> files;

    size_t triangleCount() const;  ///< counts every instance
};

}  // namespace limpid::scene
