// The internals of AccelerationStructures.
#pragma once

#include <vector>

#include "gpu/graph/resources.h"
#include "gpu/vulkan/memory/buffer.h"

namespace limpid::gpu {

/// Shared by its owner and the frames in flight.
struct AccelerationStorage : StructuresResource {
    struct Tree {
        TriangleTree source;
        UniqueAccelerationStructure handle;  ///< empty if there are no triangles
        VkDeviceAddress address = 0;
        uint64_t updateScratch = 0;  ///< offset in `scratch`, for moving trees
    };

    std::shared_ptr<const Context> context;
    std::string name;
    std::vector<Tree> trees;
    std::shared_ptr<const BufferStorage> treeBuffer;  ///< contains all trees
    uint32_t placementCount = 0;
    UniqueAccelerationStructure top;
    VkAccelerationStructureKHR topHandle = VK_NULL_HANDLE;
    std::shared_ptr<const BufferStorage> scratch;  ///< for rebuilds
    uint64_t topScratch = 0;                       ///< offset in `scratch`
    bool moves = false;                            ///< true if any tree moves
    uint64_t savedBytes = 0;

    /// Returns a VkAccelerationStructureInstanceKHR.
    InstanceRecord instanceRecord(uint32_t placement, const TreePlacement& where) const override;
    /// Refits the moving trees, then builds the top level. Reads `triangles` and `instances`.
    void recordRebuild(VkCommandBuffer commands) const;
};

/// Builds trees and top level on the device, and waits until they are done.
std::shared_ptr<const AccelerationStorage> makeAccelerationStorage(
    Device& device, const std::string& name, std::shared_ptr<const BufferResource> triangles,
    std::span<const TriangleTree> trees, std::span<const TreePlacement> placements);

/// Returns the first address in `scratch` with the alignment that builds require. makeScratch() adds the
/// space for it.
VkDeviceAddress scratchAddress(const BufferStorage& scratch);
std::shared_ptr<const BufferStorage> makeScratch(const std::shared_ptr<const Context>& context,
                                                 const std::string& name, uint64_t bytes);

/// A tree's triangles as input of a build. `info` points to `geometry`, so it cannot be moved.
struct TreeGeometry {
    TreeGeometry(const BufferStorage& triangles, const TriangleTree& tree);
    TreeGeometry(const TreeGeometry&) = delete;
    TreeGeometry& operator=(const TreeGeometry&) = delete;

    VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
    VkAccelerationStructureBuildGeometryInfoKHR info{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
    VkAccelerationStructureBuildRangeInfoKHR range{};
};

/// The input of a build of the top level.
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
