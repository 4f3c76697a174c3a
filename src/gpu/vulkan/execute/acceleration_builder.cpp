// The first build: full-size bottom levels, their compacted copies, and the top level.
#include <algorithm>
#include <deque>

#include "base/error.h"
#include "base/text/format.h"
#include "gpu/vulkan/check.h"
#include "gpu/vulkan/device_impl.h"
#include "gpu/vulkan/execute/acceleration_storage.h"

namespace limpid::gpu {
namespace {

/// The alignment that Vulkan requires for acceleration structures in a buffer.
constexpr uint64_t structureAlignment = 256;

/// Assigns consecutive offsets in a buffer.
class Layout {
  public:
    explicit Layout(uint64_t alignment) : alignment_(std::max<uint64_t>(alignment, 1)) {}
    uint64_t add(uint64_t bytes) {
        const uint64_t at = size_;
        size_ = alignUp(size_ + bytes, alignment_);
        return at;
    }
    uint64_t size() const { return std::max(size_, alignment_); }

  private:
    uint64_t alignment_, size_ = 0;
};

class Builder {
  public:
    Builder(Device& device, const std::string& name, std::shared_ptr<const BufferResource> triangles,
            std::span<const TriangleTree> trees, std::span<const TreePlacement> placements);
    std::shared_ptr<const AccelerationStorage> build();

  private:
    struct FullTree {
        UniqueAccelerationStructure handle;
        VkAccelerationStructureBuildSizesInfoKHR sizes{};
        uint64_t offset = 0;
    };

    void checkLimits() const;
    VkAccelerationStructureBuildSizesInfoKHR sizesOf(const VkAccelerationStructureBuildGeometryInfoKHR& info,
                                                     uint32_t primitives) const;
    UniqueAccelerationStructure create(const BufferStorage& buffer, uint64_t offset, uint64_t size,
                                       VkAccelerationStructureTypeKHR type, const std::string& name) const;
    void buildFullTrees();
    std::vector<VkDeviceSize> compactSizes() const;
    void compactTrees();
    void fillInstances();
    void buildTop();

    Transfer& transfer_;
    std::span<const TreePlacement> placements_;
    std::shared_ptr<AccelerationStorage> result_ = std::make_shared<AccelerationStorage>();
    std::shared_ptr<const BufferStorage> fullBuffer_;
    std::vector<FullTree> full_;
};

Builder::Builder(Device& device, const std::string& name, std::shared_ptr<const BufferResource> triangles,
                 std::span<const TriangleTree> trees, std::span<const TreePlacement> placements)
    : transfer_(device.impl().transfer()), placements_(placements) {
    result_->context = device.impl().context;
    if (!result_->context->hasRayTracing()) {
        throw Error(formatText("{} has no ray-tracing pipelines", device.info().name));
    }
    result_->name = name;
    result_->triangles = std::move(triangles);
    result_->placementCount = static_cast<uint32_t>(placements.size());
    for (const TriangleTree& tree : trees) {
        result_->trees.emplace_back().source = tree;
        result_->moves |= tree.moves;
    }
    checkLimits();
}

void Builder::checkLimits() const {
    const RayTracingLimits& limits = result_->context->rayTracing();
    const auto check = [&](std::string_view limit, uint64_t maximum, uint64_t asked) {
        if (asked <= maximum) return;
        throw Error(formatText("'{}' needs {} = {}, but {} has {}", result_->name, limit, asked,
                               result_->context->info().name, maximum));
    };
    check("maxInstanceCount", limits.maxInstances, placements_.size());
    for (const AccelerationStorage::Tree& tree : result_->trees)
        check("maxPrimitiveCount", limits.maxPrimitives, tree.source.count);
}

VkAccelerationStructureBuildSizesInfoKHR Builder::sizesOf(
    const VkAccelerationStructureBuildGeometryInfoKHR& info, uint32_t primitives) const {
    VkAccelerationStructureBuildSizesInfoKHR sizes{
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    result_->context->vk().GetAccelerationStructureBuildSizesKHR(
        result_->context->device(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &primitives,
        &sizes);
    return sizes;
}

UniqueAccelerationStructure Builder::create(const BufferStorage& buffer, uint64_t offset, uint64_t size,
                                            VkAccelerationStructureTypeKHR type,
                                            const std::string& name) const {
    VkAccelerationStructureCreateInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
    info.buffer = buffer.buffer.get();
    info.offset = offset;
    info.size = size;
    info.type = type;
    VkAccelerationStructureKHR handle = VK_NULL_HANDLE;
    LIMPID_VK(result_->context->vk().CreateAccelerationStructureKHR(result_->context->device(), &info,
                                                                    nullptr, &handle));
    result_->context->setName(handle, name);
    return {result_->context->vk(), handle};
}

void Builder::buildFullTrees() {
    Layout layout(structureAlignment);
    uint64_t scratchBytes = 0;
    std::deque<TreeGeometry> geometries;
    full_.resize(result_->trees.size());
    for (size_t i = 0; i < full_.size(); ++i) {
        const TriangleTree& source = result_->trees[i].source;
        if (source.count == 0) continue;
        TreeGeometry& geometry = geometries.emplace_back(storageOf(*result_->triangles), source);
        full_[i].sizes = sizesOf(geometry.info, source.count);
        full_[i].offset = layout.add(full_[i].sizes.accelerationStructureSize);
        scratchBytes = std::max(scratchBytes, full_[i].sizes.buildScratchSize);
    }
    if (geometries.empty()) return;
    fullBuffer_ =
        makeBuffer(result_->context, result_->name + " full trees", BufferUse::Structure, layout.size());
    const auto scratch = makeScratch(result_->context, result_->name + " build scratch", scratchBytes);
    auto geometry = geometries.begin();
    for (FullTree& tree : full_) {
        if (tree.sizes.accelerationStructureSize == 0) continue;
        tree.handle = create(*fullBuffer_, tree.offset, tree.sizes.accelerationStructureSize,
                             VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, result_->name + " full tree");
        geometry->info.dstAccelerationStructure = tree.handle.get();
        geometry->info.scratchData.deviceAddress = scratchAddress(*scratch);
        ++geometry;
    }
    // Built one after the other: they share scratch memory, and loading is not time-critical.
    transfer_.run([&](VkCommandBuffer commands) {
        for (const TreeGeometry& g : geometries) {
            passBarrier(*result_->context, commands);
            const VkAccelerationStructureBuildRangeInfoKHR* range = &g.range;
            result_->context->vk().CmdBuildAccelerationStructuresKHR(commands, 1, &g.info, &range);
        }
    });
}

/// Returns the sizes of the trees that are not empty.
std::vector<VkDeviceSize> Builder::compactSizes() const {
    std::vector<VkAccelerationStructureKHR> handles;
    for (const FullTree& tree : full_) {
        if (tree.handle) handles.push_back(tree.handle.get());
    }
    const auto count = static_cast<uint32_t>(handles.size());
    const Context& context = *result_->context;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    info.queryCount = count;
    VkQueryPool handle = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateQueryPool(context.device(), &info, nullptr, &handle));
    const UniqueQueryPool pool(context.vk(), handle);
    transfer_.run([&](VkCommandBuffer commands) {
        context.vk().CmdResetQueryPool(commands, handle, 0, count);
        passBarrier(context, commands);
        context.vk().CmdWriteAccelerationStructuresPropertiesKHR(
            commands, count, handles.data(), VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, handle,
            0);
    });
    std::vector<VkDeviceSize> sizes(count);
    LIMPID_VK(context.vk().GetQueryPoolResults(
        context.device(), handle, 0, count, count * sizeof(VkDeviceSize), sizes.data(), sizeof(VkDeviceSize),
        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    return sizes;
}

void Builder::compactTrees() {
    const std::vector<VkDeviceSize> sizes = fullBuffer_ ? compactSizes() : std::vector<VkDeviceSize>{};
    Layout layout(structureAlignment);
    std::vector<uint64_t> offsets;
    for (const VkDeviceSize size : sizes) offsets.push_back(layout.add(size));
    result_->treeBuffer =
        makeBuffer(result_->context, result_->name + " trees", BufferUse::Structure, layout.size());
    if (!fullBuffer_) return;
    result_->savedBytes = fullBuffer_->size - std::min(fullBuffer_->size, layout.size());
    size_t next = 0;
    for (size_t i = 0; i < full_.size(); ++i) {
        if (!full_[i].handle) continue;
        AccelerationStorage::Tree& tree = result_->trees[i];
        tree.handle = create(*result_->treeBuffer, offsets[next], sizes[next],
                             VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR,
                             formatText("{} tree {}", result_->name, i));
        ++next;
        VkAccelerationStructureDeviceAddressInfoKHR info{
            VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR};
        info.accelerationStructure = tree.handle.get();
        tree.address = result_->context->vk().GetAccelerationStructureDeviceAddressKHR(
            result_->context->device(), &info);
    }
    transfer_.run([&](VkCommandBuffer commands) {
        passBarrier(*result_->context, commands);
        for (size_t i = 0; i < full_.size(); ++i) {
            if (!full_[i].handle) continue;
            VkCopyAccelerationStructureInfoKHR info{VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR};
            info.src = full_[i].handle.get();
            info.dst = result_->trees[i].handle.get();
            info.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
            result_->context->vk().CmdCopyAccelerationStructureKHR(commands, &info);
        }
        passBarrier(*result_->context, commands);
    });
}

void Builder::fillInstances() {
    std::vector<StructuresResource::InstanceRecord> records;
    for (uint32_t i = 0; i < placements_.size(); ++i)
        records.push_back(result_->instanceRecord(i, placements_[i]));
    if (records.empty()) records.emplace_back();
    const auto buffer = makeBuffer(result_->context, result_->name + " instances", BufferUse::Instances,
                                   records.size() * sizeof(records.front()));
    transfer_.upload(*buffer, std::as_bytes(std::span(records)));
    result_->instances = buffer;
}

void Builder::buildTop() {
    const TopGeometry geometry(storageOf(*result_->instances), result_->placementCount, result_->moves);
    const VkAccelerationStructureBuildSizesInfoKHR sizes = sizesOf(geometry.info, result_->placementCount);
    result_->topBuffer = makeBuffer(result_->context, result_->name + " top level", BufferUse::Structure,
                                    std::max<uint64_t>(sizes.accelerationStructureSize, structureAlignment));
    result_->top = create(storageOf(*result_->topBuffer), 0, sizes.accelerationStructureSize,
                          VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, result_->name + " top level");
    result_->topHandle = result_->top.get();
    Layout scratch(result_->context->rayTracing().scratchAlignment);
    result_->topScratch = scratch.add(sizes.buildScratchSize);
    for (size_t i = 0; i < full_.size(); ++i) {
        AccelerationStorage::Tree& tree = result_->trees[i];
        if (tree.source.moves && tree.handle)
            tree.updateScratch = scratch.add(full_[i].sizes.updateScratchSize);
    }
    result_->scratch = makeScratch(result_->context, result_->name + " scratch", scratch.size());
    transfer_.run([&](VkCommandBuffer commands) {
        passBarrier(*result_->context, commands);
        result_->recordRebuild(commands);
    });
}

std::shared_ptr<const AccelerationStorage> Builder::build() {
    buildFullTrees();
    compactTrees();
    fillInstances();
    buildTop();
    return result_;
}

}  // namespace

std::shared_ptr<const AccelerationStorage> makeAccelerationStorage(
    Device& device, const std::string& name, std::shared_ptr<const BufferResource> triangles,
    std::span<const TriangleTree> trees, std::span<const TreePlacement> placements) {
    return Builder(device, name, std::move(triangles), trees, placements).build();
}

}  // namespace limpid::gpu
