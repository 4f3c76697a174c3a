#include "embree_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/error.h"

namespace limpid::bench {
namespace {

void refuse(bool present, const char* feature) {
    if (present) {
        throw Error(
            fmt::format("the yardstick renders Lambertian triangles only; this scene has {}", feature));
    }
}

void refuseWhatIsNotDiffuse(const scene::SceneFeatures& features) {
    refuse(features.textures, "textures");
    refuse(features.vertexData, "normals, coordinates or colours at vertices");
    refuse(features.alpha, "masked or blended materials");
    refuse(features.specular, "specular materials");
    refuse(features.transmission, "transmission");
    refuse(features.punctualLights, "punctual lights");
    refuse(features.environment, "an environment");
    refuse(features.mirrored, "mirrored instances");
}

float maxAbs(const vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

float magnitudeOf(const vec3& a, const vec3& b, const vec3& c) {
    return std::max({maxAbs(a), maxAbs(b), maxAbs(c)});
}

vec3 floatsOf(const uvec4& texel) {
    return {std::bit_cast<float>(texel.x), std::bit_cast<float>(texel.y), std::bit_cast<float>(texel.z)};
}

/// Returns 0 for a degenerate triangle's normal; no ray hits it.
vec3 unit(const vec3& v) {
    return v / std::max(glm::length(v), 1e-37f);
}

void check(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE)
        throw Error(fmt::format("Embree failed with error {}", static_cast<int>(error)));
}

}  // namespace

EmbreeScene::EmbreeScene(const scene::Scene& scene, const scene::SceneData& data)
    : device_(rtcNewDevice(nullptr)), lightPyramid_(data.lightPyramid) {
    check(device_.get());
    refuseWhatIsNotDiffuse(data.features);
    refuse(std::any_of(scene.materials.begin(), scene.materials.end(), [](const auto& m) { return m.unlit; }),
           "unlit materials");
    for (const scene::Material& material : scene.materials) {
        materials_.push_back({vec3(material.baseColor), material.doubleSided, material.emission});
    }
    triangles_.reserve(scene.triangleCount());
    for (size_t i = 0; i < scene.instances.size(); ++i) addInstance(scene, data, i);
    addLights(data);
    commit();
}

void EmbreeScene::addInstance(const scene::Scene& scene, const scene::SceneData& data, size_t index) {
    const scene::Instance& instance = scene.instances[index];
    const scene::Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const uint32_t firstDensity = data.instances[index * layout::INSTANCE_TEXELS + 3].y;
    for (size_t t = 0; t < mesh.triangleCount(); ++t) {
        vec3 v[3];
        for (size_t k = 0; k < 3; ++k) {
            v[k] = vec3(instance.transform * vec4(mesh.positions[mesh.indices[3 * t + k]], 1.0f));
        }
        const uint32_t slot = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[t];
        const vec3 edge1 = v[1] - v[0], edge2 = v[2] - v[0];
        triangles_.push_back(
            {.v0 = v[0],
             .magnitude = magnitudeOf(v[0], v[1], v[2]),
             .edge1 = edge1,
             .material = static_cast<uint32_t>(instance.material) + slot,
             .edge2 = edge2,
             .lightDensity = firstDensity == layout::NONE ? 0.0f : data.lightDensity[firstDensity + t],
             .normal = unit(glm::cross(edge1, edge2))});
    }
}

void EmbreeScene::addLights(const scene::SceneData& data) {
    for (size_t at = 0; at < data.lights.size(); at += layout::LIGHT_TEXELS) {
        const uvec4* texel = &data.lights[at];
        const vec3 v0 = floatsOf(texel[0]), v1 = floatsOf(texel[1]), v2 = floatsOf(texel[2]);
        const vec3 perpendicular = glm::cross(v1 - v0, v2 - v0);
        lights_.push_back(
            {.v0 = v0,
             .magnitude = magnitudeOf(v0, v1, v2),
             .edge1 = v1 - v0,
             .probability = std::bit_cast<float>(texel[1].w),
             .edge2 = v2 - v0,
             .doubleArea = glm::length(perpendicular),
             .normal = unit(perpendicular),
             .twoSided = (texel[0].w & layout::LIGHT_KIND_MASK) == layout::LIGHT_TRIANGLE_TWO_SIDED,
             .emission = floatsOf(texel[3])});
    }
}

void EmbreeScene::commit() {
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    const auto release = [](RTCGeometry geometry) { rtcReleaseGeometry(geometry); };
    const std::unique_ptr<std::remove_pointer_t<RTCGeometry>, decltype(release)> geometry(
        rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE), release);
    check(device_.get());
    rtcSetGeometryBuildQuality(geometry.get(), RTC_BUILD_QUALITY_HIGH);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                                 RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                                 3 * triangles_.size()));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), triangles_.size()));
    check(device_.get());
    for (const TriangleRecord& t : triangles_) {
        for (const vec3& v : {t.v0, t.v0 + t.edge1, t.v0 + t.edge2}) {
            for (int axis = 0; axis < 3; ++axis) *vertices++ = v[axis];
        }
    }
    for (uint32_t i = 0; i < 3 * triangles_.size(); ++i) *indices++ = i;
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene_.get(), geometry.get(), 0);
    rtcCommitScene(scene_.get());
    check(device_.get());
}

std::string embreeVersion() {
    const auto release = [](RTCDevice device) { rtcReleaseDevice(device); };
    const std::unique_ptr<std::remove_pointer_t<RTCDevice>, decltype(release)> device(rtcNewDevice(nullptr),
                                                                                      release);
    check(device.get());
    const auto property = [&](RTCDeviceProperty name) { return rtcGetDeviceProperty(device.get(), name); };
    const char* instructions = property(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0  ? "AVX-512"
                               : property(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0 ? "AVX or AVX2"
                                                                                          : "SSE or NEON";
    return fmt::format("{}.{}.{}, {}", property(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                       property(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                       property(RTC_DEVICE_PROPERTY_VERSION_PATCH), instructions);
}

}  // namespace limpid::bench
