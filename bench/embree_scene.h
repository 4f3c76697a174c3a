// A diffuse scene in Embree, with the tables that a native path tracer wants: one cache line a triangle.
#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <string>
#include <vector>

#include "scene/device/scene_data.h"

namespace limpid::bench {

/// What shading needs of a triangle, in world space.
struct alignas(64) TriangleRecord {
    vec3 v0;
    float
        magnitude;  ///< the largest coordinate of the three vertices: its rounding decides how far rays start
    vec3 edge1;
    uint32_t material;
    vec3 edge2;
    float lightDensity;  ///< per area, with which next-event estimation draws a point here; 0: no light
    vec3 normal;         ///< unit, of the side that the winding calls front
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
    /// `data` is what buildSceneData() made of `scene`: the light tables come from there, so that both
    /// tracers draw the same lights. Throws Error naming the feature if the scene has more than Lambertian
    /// triangles, some of which emit, or if Embree fails.
    EmbreeScene(const scene::Scene& scene, const scene::SceneData& data);

    RTCScene handle() const { return scene_.get(); }
    const std::vector<TriangleRecord>& triangles() const { return triangles_; }  ///< by Embree's primitive
    const std::vector<MaterialRecord>& materials() const { return materials_; }
    const std::vector<LightRecord>& lights() const { return lights_; }
    const std::vector<scene::AliasEntry>& lightAlias() const { return lightAlias_; }

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
    std::vector<scene::AliasEntry> lightAlias_;
};

/// "3.13.5, AVX2": Embree's version and the widest instructions that it uses on this machine.
std::string embreeVersion();

}  // namespace limpid::bench
