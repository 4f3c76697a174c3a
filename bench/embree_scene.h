// A diffuse scene in Embree, with tables laid out for a native path tracer: one cache line per triangle.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <string>
#include <vector>

#include "scene/device/scene_data.h"

namespace limpid::bench {

/// What shading needs to know about a triangle, in world space.
struct alignas(64) TriangleRecord {
    vec3 v0;
    float magnitude;  ///< the largest coordinate of the three vertices: its rounding error sets the offset of
                      ///< ray origins
    vec3 edge1;
    uint32_t material;
    vec3 edge2;
    float lightDensity;  ///< probability density per area with which next-event estimation samples a point
                         ///< here; 0: not a light
    vec3 normal;         ///< unit; on the side that the winding order calls front
};
static_assert(sizeof(TriangleRecord) == 64);

struct MaterialRecord {
    vec3 albedo;
    bool doubleSided;
    vec3 emission;
};

struct LightRecord {
    vec3 v0;
    float magnitude;
    vec3 edge1;
    float probability;  ///< of being chosen
    vec3 edge2;
    float doubleArea;
    vec3 normal;
    bool twoSided;
    vec3 emission;
};

/// Owns Embree's device and scene. Built with RTC_BUILD_QUALITY_HIGH and no other flag.
class EmbreeScene {
  public:
    /// `data` must be the result of buildSceneData(scene): the light tables come from there, so that both
    /// tracers sample the same lights. The scene may only have Lambertian triangles, with or without
    /// emission; for anything else throws Error, naming the feature. Also throws Error if Embree fails.
    EmbreeScene(const scene::Scene& scene, const scene::SceneData& data);

    RTCScene handle() const { return scene_.get(); }
    /// Indexed by Embree's primitive number.
    const std::vector<TriangleRecord>& triangles() const { return triangles_; }
    const std::vector<MaterialRecord>& materials() const { return materials_; }
    const std::vector<LightRecord>& lights() const { return lights_; }
    const std::vector<vec4>& lightPyramid() const { return lightPyramid_; }

  private:
    struct ReleaseDevice {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    };
    struct ReleaseScene {
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };

    void addInstance(const scene::Scene& scene, const scene::SceneData& data, size_t index);
    void addLights(const scene::SceneData& data);
    void commit();

    std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene> scene_;
    std::vector<TriangleRecord> triangles_;
    std::vector<MaterialRecord> materials_;
    std::vector<LightRecord> lights_;
    std::vector<vec4> lightPyramid_;
};

/// Returns Embree's version and the widest instruction set it uses on this machine, such as "3.13.5, AVX2".
std::string embreeVersion();

}  // namespace limpid::bench
