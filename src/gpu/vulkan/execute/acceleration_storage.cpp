// The inputs of acceleration-structure builds, and the rebuild in each frame.
#include "gpu/vulkan/execute/acceleration_storage.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <deque>

#include "base/error.h"
#include "base/text/format.h"
#include "gpu/vulkan/device_impl.h"

namespace limpid::gpu {

VkDeviceAddress scratchAddress(const BufferStorage& scratch) {
    return alignUp(deviceAddress(scratch), std::max(1u, scratch.context->rayTracing().scratchAlignment));
}

std::shared_ptr<const BufferStorage> makeScratch(const std::shared_ptr<const Context>& context,
                                                 const std::string& name, uint64_t bytes) {
    return makeBuffer(context, name, BufferUse::Scratch, bytes + context->rayTracing().scratchAlignment);
}

TreeGeometry::TreeGeometry(const BufferStorage& triangles, const TriangleTree& tree) {
    constexpr uint32_t cornerBytes = 16;
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    // The any-hit shader may run twice for a triangle, since its decision is deterministic.
    geometry.flags = tree.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : 0;
    VkAccelerationStructureGeometryTrianglesDataKHR& data = geometry.geometry.triangles;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
    data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    data.vertexData.deviceAddress = deviceAddress(triangles) + uint64_t{tree.first} * 3 * cornerBytes;
    data.vertexStride = cornerBytes;
    data.maxVertex = 3 * tree.count - 1;
    data.indexType = VK_INDEX_TYPE_NONE_KHR;
    info.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
    info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR |
                 VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
    if (tree.moves) info.flags |= VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = 1;
    info.pGeometries = &geometry;
    range.primitiveCount = tree.count;
}

TopGeometry::TopGeometry(const BufferStorage& instances, uint32_t count, bool moves) {
    geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    VkAccelerationStructureGeometryInstancesDataKHR& data = geometry.geometry.instances;
    data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    data.data.deviceAddress = deviceAddress(instances);
    info.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
    info.flags = moves ? VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR
                       : VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
    info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
    info.geometryCount = 1;
    info.pGeometries = &geometry;
    range.primitiveCount = count;
}

StructuresResource::InstanceRecord AccelerationStorage::instanceRecord(uint32_t placement,
                                                                       const TreePlacement& where) const {
    if (placement >= placementCount || where.tree >= trees.size()) {
        throw Error(formatText("'{}' has no placement {} or no tree {}", name, placement, where.tree));
    }
    VkAccelerationStructureInstanceKHR record{};
    static_assert(sizeof(record.transform.matrix) == sizeof(where.toWorld));
    std::memcpy(record.transform.matrix, where.toWorld.data(), sizeof(where.toWorld));
    record.mask = 0xff;
    record.flags = VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR;
    // An instance without a tree is inactive.
    record.accelerationStructureReference = where.visible ? trees[where.tree].address : 0;
    static_assert(sizeof(record) == sizeof(InstanceRecord));
    return std::bit_cast<InstanceRecord>(record);
}

void AccelerationStorage::recordRebuild(VkCommandBuffer commands) const {
    std::deque<TreeGeometry> geometries;
    std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
    std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
    const VkDeviceAddress firstScratch = scratchAddress(*scratch);
    for (const Tree& tree : trees) {
        if (!tree.source.moves || !tree.handle) continue;
        TreeGeometry& built = geometries.emplace_back(storageOf(*triangles), tree.source);
        built.info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
        built.info.srcAccelerationStructure = built.info.dstAccelerationStructure = tree.handle.get();
        built.info.scratchData.deviceAddress = firstScratch + tree.updateScratch;
        infos.push_back(built.info);
        ranges.push_back(&built.range);
    }
    if (!infos.empty()) {
        context->vk().CmdBuildAccelerationStructuresKHR(commands, static_cast<uint32_t>(infos.size()),
                                                        infos.data(), ranges.data());
        passBarrier(*context, commands);
    }
    TopGeometry built(storageOf(*instances), placementCount, moves);
    built.info.dstAccelerationStructure = topHandle;
    built.info.scratchData.deviceAddress = firstScratch + topScratch;
    const VkAccelerationStructureBuildRangeInfoKHR* range = &built.range;
    context->vk().CmdBuildAccelerationStructuresKHR(commands, 1, &built.info, &range);
}

AccelerationStructures::AccelerationStructures(Device& device, const std::string& name,
                                               const Buffer& triangles, std::span<const TriangleTree> trees,
                                               std::span<const TreePlacement> placements)
    : resource_(makeAccelerationStorage(device, name, triangles.resource(), trees, placements)) {}

uint64_t AccelerationStructures::byteCount() const {
    const auto& s = static_cast<const AccelerationStorage&>(*resource_);
    return s.treeBuffer->size + s.topBuffer->size + s.instances->size + s.scratch->size;
}

uint64_t AccelerationStructures::bytesSavedByCompaction() const {
    return static_cast<const AccelerationStorage&>(*resource_).savedBytes;
}

}  // namespace limpid::gpu
