#include "scene/device/gpu_scene.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include "base/error.h"
#include "scene/device/lights/lamps.h"
#include "scene/prepare/expanded_nodes.h"

namespace limpid::scene {

namespace {

/// Drivers split triangles themselves, if they do, and would test repeated ones twice. Vulkan ignores a
/// triangle whose first coordinate is NaN.
RawVector<vec4> withoutRepeats(const SceneData& data) {
    RawVector<vec4> triangles = data.bvhTriangles;
    for (const uint32_t index : data.repeatedTriangles)
        triangles[size_t{index} * layout::BVH_TRIANGLE_TEXELS].x = std::numeric_limits<float>::quiet_NaN();
    return triangles;
}

}  // namespace

GpuScene::GpuScene(gpu::Device& device, const SceneData& data, const TraceOptions& options)
    : features_(data.features),
      params_(data.params),
      stackSize_(data.stackSize),
      gpuTraversal_(options.tracer == Tracer::Compute && options.gpuTraversal.value_or(!device.isCpu())) {
    using gpu::Format;
    const auto add = [&](const char* name, Format format, const auto& values) {
        buffers_.push_back(
            {name, device.createTexelBuffer(std::string("scene/") + name, format, gpu::bytesOf(values))});
    };
    addNodes(device, data);
    if (options.tracer == Tracer::Hardware)
        add("bvhTriangles", Format::RGBA32Float, withoutRepeats(data));
    else
        add("bvhTriangles", Format::RGBA32Float, data.bvhTriangles);
    add("bvhInstances", Format::RGBA32Uint, data.bvhInstances);
    add("triangles", Format::RGBA32Uint, data.triangles);
    add("vertices", Format::RGBA32Uint, data.vertices);
    add("instances", Format::RGBA32Uint, data.instances);
    add("previousGeometry", Format::RGBA32Uint, data.previousGeometry);
    add("materials", Format::RGBA32Uint, data.materials);
    add("textureRefs", Format::RGBA32Uint, data.textureRefs);
    add("lights", Format::RGBA32Uint, data.lights);
    add("lightPyramid", Format::RGBA32Float, data.lightPyramid);
    add("lightDensity", Format::R32Float, data.lightDensity);
    add("lightTree", Format::RGBA32Uint, data.lightTree);
    add("environment", Format::RGBA32Float, data.environment);
    add("environmentPyramid", Format::RGBA32Float, data.environmentPyramid);
    add("ggxTable", Format::RGBA32Float, data.ggxTable);
    add("dielectricTable", Format::RGBA32Float, data.dielectricTable);
    constexpr std::array<const char*, layout::TEXEL_BUFFERS> names{"texels0", "texels1", "texels2",
                                                                   "texels3"};
    for (uint32_t i = 0; i < layout::TEXEL_BUFFERS; ++i) {
        add(names[i], Format::R32Uint, data.texels[i]);
        if (!data.texels[i].empty()) texelBufferCount_ = i + 1;
    }
    addLightDistances(device, data);
    if (!data.motion.deforming.empty()) addDeformBuffers(device, data);
    if (options.tracer == Tracer::Hardware) {
        structures_.emplace(device, "scene/structures", buffer("bvhTriangles"), data.trees, data.placements);
    }
}

void GpuScene::addNodes(gpu::Device& device, const SceneData& data) {
    const auto add = [&](std::vector<NamedBuffer>& list, const char* name, const std::vector<uvec4>& nodes) {
        list.push_back({name, device.createTexelBuffer(std::string("scene/") + name, gpu::Format::RGBA32Uint,
                                                       gpu::bytesOf(nodes))});
    };
    if (!gpuTraversal_) return add(buffers_, "bvhNodes", data.bvhNodes);
    add(buffers_, "bvhNodes", expandNodes(data.bvhNodes));
    if (data.motion.moving) add(passBuffers_, "quantisedNodes", data.bvhNodes);
}

void GpuScene::addLightDistances(gpu::Device& device, const SceneData& data) {
    const auto add = [&](std::vector<NamedBuffer>& list, const char* name, const std::vector<float>& values) {
        list.push_back({name, device.createTexelBuffer(std::string("scene/") + name, gpu::Format::R32Float,
                                                       gpu::bytesOf(values))});
    };
    if (!features_.lightDistances) return add(buffers_, "lightDistances", {});
    mappedLights_ = std::min(data.params.punctualCount, layout::LIGHT_MAPS);
    // Two upper halves of floats, both above LIGHT_MAP_NOT_HIDDEN.
    constexpr auto notHidden = std::bit_cast<float>(0x714A714Au);
    const std::vector<float> values(size_t{mappedLights_} * layout::LIGHT_MAP_SIZE * layout::LIGHT_MAP_SIZE,
                                    notHidden);
    add(buffers_, "lightDistances", values);
    add(passBuffers_, "lightFirstHits", values);
    lightDistancesStale_ = true;
}

void GpuScene::addDeformBuffers(gpu::Device& device, const SceneData& data) {
    using gpu::Format;
    const auto add = [&](const char* name, Format format, const auto& values) {
        passBuffers_.push_back(
            {name, device.createTexelBuffer(std::string("scene/") + name, format, gpu::bytesOf(values))});
    };
    uint64_t vertices = 0, matrices = 0;
    for (const DeformingInstance& d : data.motion.deforming) {
        vertices += d.vertexCount;
        // Matrices of this frame and the previous one.
        matrices += 2 * (uint64_t{d.jointCount} * layout::POSE_MATRIX_TEXELS + (d.targetCount + 3) / 4);
    }
    add("restVertices", Format::RGBA32Uint, data.motion.restVertices);
    add("morphDeltas", Format::RGBA32Float, data.motion.morphDeltas);
    add("poseMatrices", Format::RGBA32Float, std::vector<vec4>(matrices));
    add("posedVertices", Format::RGBA32Float, std::vector<vec4>(vertices));
    add("refitNodes", Format::R32Uint, data.motion.refitNodes);
    add("nodeBounds", Format::RGBA32Float,
        std::vector<vec4>(uint64_t{data.motion.refitNodeCount} * layout::NODE_BOUNDS_TEXELS));
}

const gpu::Buffer& GpuScene::buffer(std::string_view name) const {
    if (name == "quantisedNodes" && !gpuTraversal_) name = "bvhNodes";
    for (const auto* list : {&buffers_, &passBuffers_}) {
        for (const NamedBuffer& named : *list) {
            if (named.name == name) return named.buffer;
        }
    }
    throw Error("the scene has no buffer '" + std::string(name) + "'");
}

std::vector<gpu::Binding> GpuScene::bindings() const {
    std::vector<gpu::Binding> result;
    for (const NamedBuffer& named : buffers_) result.push_back({named.name, &named.buffer});
    if (structures_) result.push_back({"topLevel", &*structures_});
    return result;
}

std::vector<gpu::ConstantValue> GpuScene::constants() const {
    return {{"TWO_LEVEL", features_.twoLevel},
            {"HAS_VERTEX_DATA", features_.vertexData},
            {"HAS_TEXTURES", features_.textures},
            {"HAS_ALPHA", features_.alpha},
            {"HAS_SPECULAR", features_.specular},
            {"HAS_TRANSMISSION", features_.transmission},
            {"HAS_TRIANGLE_LIGHTS", features_.triangleLights},
            {"HAS_PUNCTUAL_LIGHTS", features_.punctualLights},
            {"HAS_ENVIRONMENT", features_.environment},
            {"HAS_MIRRORED", features_.mirrored},
            {"HAS_MOTION", features_.motion},
            {"HAS_CLEARCOAT", features_.clearcoat},
            {"HAS_VOLUME", features_.volume},
            {"HAS_SPECULAR_TEXTURES", features_.specularTextures},
            {"HAS_ROUGH_GLASS", features_.roughGlass},
            {"HAS_LIGHT_TREE", features_.lightTree},
            {"HAS_SUNS", features_.suns},
            {"HAS_ANISOTROPY", features_.anisotropy},
            {"HAS_SHEEN", features_.sheen},
            {"HAS_DIFFUSE_TRANSMISSION", features_.diffuseTransmission},
            {"HAS_DISPERSION", features_.dispersion},
            {"HAS_IRIDESCENCE", features_.iridescence},
            {"HAS_LIGHT_DISTANCES", features_.lightDistances},
            {"HAS_PANES", features_.panes},
            {"HAS_BLENDED", features_.blended},
            {"STACK_SIZE", stackSize_ + 3},  // up to three writes beyond the top are made and ignored
            {"TEXEL_BUFFER_COUNT", texelBufferCount_},
            {"CPU_LOOPS", !gpuTraversal_},
            {"EXPANDED_NODES", gpuTraversal_}};
}

bool GpuScene::usesLightTree(bool wanted) const {
    return features_.lightTree && (wanted || params_.punctualCount - params_.sunCount > maxEvaluatedLights);
}

uint64_t GpuScene::byteCount() const {
    uint64_t sum = 0;
    for (const NamedBuffer& named : buffers_) sum += named.buffer.size();
    for (const NamedBuffer& named : passBuffers_) sum += named.buffer.size();
    if (structures_) sum += structures_->byteCount();
    return sum;
}

}  // namespace limpid::scene
