// The inside of AccelerationStructures.
#pragma once

#include <vector>

#include "gpu/graph/resources.h"
#include "gpu/vulkan/memory/buffer.h"

namespace limpid::gpu {

/// Shared by its owner and the frames under way.
struct AccelerationStorage : StructuresResource {
    struct Tree {
        TriangleTree source;
        UniqueAccelerationStructure handle;  ///< empty if it has no triangles
        VkDeviceAddress address = 0;
        uint64_t updateScratch = 0;  ///< offset in `scratch`, of trees that move
    };

    std::shared_ptr<const Context> context;
    std::string name;
    std::vector<Tree> trees;
    std::shared_ptr<const BufferStorage> treeBuffer;  ///< where all trees lie
    uint32_t placementCount = 0;
    UniqueAccelerationStructure top;
    VkAccelerationStructureKHR topHandle = VK_NULL_HANDLE;
    std::shared_ptr<const BufferStorage> scratch;  ///< of rebuilds
    uint64_t topScratch = 0;                       ///< offset in `scratch`
    bool moves = false;                            ///< some tree does
    uint64_t savedBytes = 0;

    /// A VkAccelerationStructureInstanceKHR.
    InstanceRecord instanceRecord(uint32_t placement, const TreePlacement& where) const override;
    /// Fits the trees that move, then builds the top level. Reads what lies in `triangles` and `instances`.
    void recordRebuild(VkCommandBuffer commands) const;
};

/// Builds trees and top level on the device, and waits for it.
std::shared_ptr<const AccelerationStorage> makeAccelerationStorage(
    Device& device, const std::string& name, std::shared_ptr<const BufferResource> triangles,
    std::span<const TriangleTree> trees, std::span<const TreePlacement> placements);

/// The first address in `scratch` that is aligned as builds want it. makeScratch() leaves room for that.
VkDeviceAddress scratchAddress(const BufferStorage& scratch);
std::shared_ptr<const BufferStorage> makeScratch(const std::shared_ptr<const Context>& context,
                                                 const std::string& name, uint64_t bytes);

/// What a build is told of a tree's triangles. `info` points to `geometry`, so it stays where it is.
struct TreeGeometry {
    TreeGeometry(const BufferStorage& triangles, const TriangleTree& tree);
    TreeGeometry(const TreeGeometry&) = delete;
    TreeGeometry& operator=(const TreeGeometry&) = delete;

    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    VkAccelerationStructureBuildGeometryInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    VkAccelerationStructureBuildRangeInfoKHR range{};
};

/// The same of the top level.
struct TopGeometry {
    TopGeometry(const BufferStorage& instances, uint32_t count, bool moves);
    TopGeometry(const TopGeometry&) = delete;
    TopGeometry& operator=(const TopGeometry&) = delete;

    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    VkAccelerationStructureBuildGeometryInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    VkAccelerationStructureBuildRangeInfoKHR range{};
};

}  // namespace limpid::gpu
