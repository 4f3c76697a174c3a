#include "scene/load/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/model/aabb.h"
#include "scene/model/transform.h"
#include "scene/prepare/mesh_repair.h"

namespace limpid::scene {
namespace {

using Fault = std::optional<std::string>;

bool inRange(int index, size_t size) {
    return index >= 0 && static_cast<size_t>(index) < size;
}

bool isFiniteMatrix(const mat4& m) {
    return isFinite(m[0]) && isFinite(m[1]) && isFinite(m[2]) && isFinite(m[3]);
}

bool isRadiance(const vec3& v) {
    return isFinite(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f;
}

bool isUnit(const vec3& v) {
    return std::abs(glm::dot(v, v) - 1.0f) < 1e-2f;
}

template <typename Vector>
bool fits(const std::vector<Vector>& values, const Mesh& mesh) {
    return values.empty() || values.size() == mesh.positions.size();
}

/// Checks the lengths of a deformation's arrays, which are later indexed by vertex without checks.
bool fitsDeformation(const Mesh& mesh) {
    const Deformation& d = *mesh.deformation;
    const auto sameAs = [&](const auto& values, bool present) {
        return values.size() == (present ? mesh.positions.size() : 0);
    };
    const bool targets = std::all_of(d.targets.begin(), d.targets.end(), [&](const MorphTarget& target) {
        return fits(target.positions, mesh) && fits(target.normals, mesh) && fits(target.tangents, mesh);
    });
    return targets && sameAs(d.positions, true) && sameAs(d.normals, !mesh.normals.empty()) &&
           sameAs(d.tangents, !mesh.tangents.empty()) && fits(d.joints, mesh) && fits(d.weights, mesh) &&
           d.joints.size() == d.weights.size();
}

Fault checkMesh(const Mesh& mesh) {
    if (mesh.indices.size() % 3 != 0) return "has an incomplete triangle";
    if (!mesh.materialSlots.empty() && mesh.materialSlots.size() != mesh.triangleCount()) {
        return "does not have one material slot per triangle";
    }
    if (!fits(mesh.normals, mesh) || !fits(mesh.tangents, mesh) || !fits(mesh.uv0, mesh) ||
        !fits(mesh.uv1, mesh) || !fits(mesh.colors, mesh)) {
        return "has an attribute of another length than its positions";
    }
    if (mesh.deformation && !fitsDeformation(mesh)) return "has a deformation of other vertices than its own";
    const size_t vertices = mesh.positions.size();
    if (!std::all_of(mesh.indices.begin(), mesh.indices.end(), [&](uint32_t i) { return i < vertices; })) {
        return "has an index out of range";
    }
    const auto finite = [](const auto& values) {
        return std::all_of(values.begin(), values.end(), [](const auto& v) { return isFinite(v); });
    };
    if (!finite(mesh.positions)) return "has a position that is not finite";
    if (!finite(mesh.uv0) || !finite(mesh.uv1) || !finite(mesh.colors))
        return "has an attribute that is not finite";
    if (!std::all_of(mesh.normals.begin(), mesh.normals.end(), isUnit))
        return "has a normal that is not of unit length";
    const auto isTangent = [](const vec4& t) { return isUnit(vec3(t)) && std::abs(t.w) == 1.0f; };
    if (!std::all_of(mesh.tangents.begin(), mesh.tangents.end(), isTangent)) return "has a malformed tangent";
    return {};
}

bool isUnitColor(const vec3& color) {
    return glm::all(glm::greaterThanEqual(color, vec3(0.0f))) &&
           glm::all(glm::lessThanEqual(color, vec3(1.0f)));
}

Fault checkMaterial(const Material& m, size_t textures) {
    const auto unit = [](float v) { return v >= 0.0f && v <= 1.0f; };
    if (!isFinite(m.baseColor) || !isRadiance(vec3(m.baseColor)) || !unit(m.baseColor.a))
        return "has a bad base colour";
    if (!unit(m.metallic) || !unit(m.roughness) || !unit(m.specular) || !unit(m.transmission) ||
        !unit(m.clearcoat) || !unit(m.clearcoatRoughness) || !unit(m.anisotropy) || !unit(m.sheenRoughness) ||
        !unit(m.diffuseTransmission) || !unit(m.iridescence)) {
        return "has a factor that is not between 0 and 1";
    }
    if (!(m.ior >= 1.0f && std::isfinite(m.ior))) return "has an index of refraction below 1";
    if (!isUnitColor(m.sheenColor) || !isUnitColor(m.diffuseTransmissionColor))
        return "has a colour that is not between 0 and 1";
    if (!(m.dispersion >= 0.0f && std::isfinite(m.dispersion)) || !std::isfinite(m.anisotropyRotation))
        return "has a dispersion below 0, or an anisotropy that is not finite";
    const auto isThickness = [](float v) { return v >= 0.0f && v <= 1e9f; };
    if (!(m.iridescenceIor >= 1.0f && std::isfinite(m.iridescenceIor)) ||
        !isThickness(m.iridescenceThicknessMin) || !isThickness(m.iridescenceThicknessMax))
        return "has a film with a bad index of refraction or thickness";
    if (!isRadiance(m.absorption)) return "has an absorption that is negative or not finite";
    if (!isRadiance(m.emission)) return "has an emission that is negative or not finite";
    if (!std::isfinite(m.normalScale) || !std::isfinite(m.clearcoatNormalScale) ||
        !std::isfinite(m.alphaCutoff))
        return "has a value that is not finite";
    for (const TextureRef* ref :
         {&m.baseColorTexture, &m.metallicRoughnessTexture, &m.normalTexture, &m.occlusionTexture,
          &m.emissionTexture, &m.transmissionTexture, &m.specularTexture, &m.specularColorTexture,
          &m.clearcoatTexture, &m.clearcoatRoughnessTexture, &m.clearcoatNormalTexture, &m.anisotropyTexture,
          &m.iridescenceTexture, &m.iridescenceThicknessTexture, &m.sheenColorTexture,
          &m.sheenRoughnessTexture, &m.diffuseTransmissionTexture, &m.diffuseTransmissionColorTexture}) {
        if (!*ref) continue;
        if (!inRange(ref->texture, textures)) return "uses a texture that does not exist";
        if (ref->uvSet != 0 && ref->uvSet != 1) return "uses a texture coordinate set that does not exist";
        if (!isFinite(ref->rowU) || !isFinite(ref->rowV)) return "has a texture transform that is not finite";
    }
    return {};
}

/// Checks the mesh's bounds in a space.
bool staysInRange(const vec3& lower, const vec3& upper, const mat4& toSpace) {
    for (int i = 0; i < 8; ++i) {
        const vec3 size = glm::abs(transformPoint(toSpace, Aabb{lower, upper}.corner(i)));
        if (!(size.x < coordinateLimit && size.y < coordinateLimit && size.z < coordinateLimit)) return false;
    }
    return true;
}

struct MeshUse {
    vec3 lower{0.0f}, upper{0.0f};
    int lastSlot = 0;
};

MeshUse summarize(const Mesh& mesh) {
    MeshUse use;
    if (!mesh.positions.empty()) use.lower = use.upper = mesh.positions[0];
    for (const vec3& position : mesh.positions) {
        use.lower = glm::min(use.lower, position);
        use.upper = glm::max(use.upper, position);
    }
    for (const uint16_t slot : mesh.materialSlots) use.lastSlot = std::max(use.lastSlot, int{slot});
    return use;
}

Fault checkInstances(const Scene& scene) {
    std::vector<MeshUse> uses;
    for (const Mesh& mesh : scene.meshes) uses.push_back(summarize(mesh));
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const auto fault = [&](const char* text) {
            return fmt::format("instance {} '{}' {}", i, instance.name, text);
        };
        if (!inRange(instance.mesh, uses.size())) return fault("uses a mesh that does not exist");
        const MeshUse& use = uses[static_cast<size_t>(instance.mesh)];
        if (instance.material < 0 || !inRange(instance.material + use.lastSlot, scene.materials.size())) {
            return fault("uses a material that does not exist");
        }
        if (!isFiniteMatrix(instance.transform)) return fault("has a transform that is not finite");
        if (!staysInRange(use.lower, use.upper, instance.transform))
            return fault("is too far away or too large: coordinates must be below 1e12");
        if (!staysInRange(use.lower, use.upper, mat4(1.0f)))
            return fault("uses a mesh that is too large: coordinates must be below 1e12");
    }
    return {};
}

Fault checkLight(const PunctualLight& light) {
    if (!isFinite(light.position) || !isUnit(light.direction)) return "has a bad position or direction";
    if (!isRadiance(light.intensity)) return "has an intensity that is negative or not finite";
    if (!(light.range >= 0.0f)) return "has a negative range";
    const bool cones = light.innerCone >= 0.0f && light.innerCone < light.outerCone && light.outerCone <= pi;
    if (light.kind == PunctualLight::Kind::Spot && !cones) return "has bad cone angles";
    return {};
}

Fault checkCamera(const Camera& camera) {
    if (!isFiniteMatrix(camera.toWorld)) return "has a transform that is not finite";
    if (!isUnit(vec3(camera.toWorld[0])) || !isUnit(vec3(camera.toWorld[1])) ||
        !isUnit(vec3(camera.toWorld[2]))) {
        return "has a scaled transform";
    }
    if (camera.orthographic && !(camera.halfHeight > 0.0f)) return "has a view without height";
    if (!camera.orthographic && !(camera.verticalFov > 0.0f && camera.verticalFov < pi))
        return "has a bad field of view";
    if (!(camera.aspect >= 0.0f) || !std::isfinite(camera.aspect)) return "has a bad aspect ratio";
    return {};
}

Fault checkTexture(const Texture& texture) {
    if (texture.width == 0 || texture.height == 0) return "is empty";
    if (texture.rgba.size() != size_t{4} * texture.width * texture.height) return "has texels missing";
    return {};
}

template <typename Item, typename Check>
Fault checkAll(const char* kind, const std::vector<Item>& items, const Check& check) {
    for (size_t i = 0; i < items.size(); ++i) {
        if (const Fault fault = check(items[i]))
            return fmt::format("{} {} '{}' {}", kind, i, items[i].name, *fault);
    }
    return {};
}

}  // namespace

std::optional<std::string> findFault(const Scene& scene) {
    if (scene.materials.empty()) return "the scene has no materials";
    const size_t textures = scene.textures.size();
    if (Fault f = checkAll("mesh", scene.meshes, checkMesh)) return f;
    if (Fault f = checkAll("texture", scene.textures, checkTexture)) return f;
    if (Fault f = checkAll("material", scene.materials,
                           [&](const Material& m) { return checkMaterial(m, textures); })) {
        return f;
    }
    if (Fault f = checkInstances(scene)) return f;
    if (Fault f = checkAll("light", scene.lights, checkLight)) return f;
    if (Fault f = checkAll("camera", scene.cameras, checkCamera)) return f;
    const Environment& environment = scene.environment;
    const bool hasExtent = environment.width != 0 || environment.height != 0;
    if (environment.radiance.size() != size_t{environment.width} * environment.height ||
        hasExtent == environment.empty()) {
        return "the environment has pixels missing";
    }
    if (!std::all_of(environment.radiance.begin(), environment.radiance.end(), isRadiance)) {
        return "the environment has a radiance that is negative or not finite";
    }
    return {};
}

}  // namespace limpid::scene
