// Records frames, images and histories. dispatch_recorder.cpp records dispatches, frame_executor.cpp
// executes.
#include "gpu/graph/frame_graph.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/text/format.h"
#include "gpu/graph/dispatch_recorder.h"
#include "gpu/graph/frame_graph_impl.h"

namespace limpid::gpu {
namespace {

/// A handle's lower bits are the image's index, its upper bits the frame's number modulo `generations`, which
/// is one less than the bits allow, so that no handle equals the empty one.
constexpr uint32_t indexBits = 20;
constexpr uint32_t indexMask = (1u << indexBits) - 1;
constexpr uint32_t generations = (1u << (32 - indexBits)) - 1;

uint32_t generation(uint64_t frame) {
    return static_cast<uint32_t>(frame % generations);
}

using CodePointer = std::shared_ptr<const ShaderCode>;

bool sameCode(const Shader& shader, std::span<const CodePointer> codes) {
    return std::ranges::equal(shader.stages, codes, [](const ShaderCode& stage, const CodePointer& code) {
        return stage.hash == code->hash && stage.words.size() == code->words.size();
    });
}

constexpr std::array<ShaderStage, 4> rayStages{ShaderStage::RayGeneration, ShaderStage::Miss,
                                               ShaderStage::ClosestHit, ShaderStage::AnyHit};

/// One code is a compute shader; four are a ray-tracing pipeline, in the order of `rayStages`.
std::shared_ptr<const Shader> makeShader(std::span<const CodePointer> codes) {
    const auto shader = std::make_shared<Shader>();
    shader->name = codes[0]->name;
    shader->reflection = codes[0]->reflection;
    for (size_t i = 0; i < codes.size(); ++i) {
        const ShaderCode& code = *codes[i];
        const ShaderStage wanted = codes.size() == 1 ? ShaderStage::Compute : rayStages[i];
        if (code.reflection.stage != wanted)
            throw Error(formatText("shader '{}' is of another stage than its use", code.name));
        shader->stages.push_back(code);
        shader->hash = shader->hash * 0x100000001B3u ^ code.hash;
        if (codes[i].use_count() != 0) shader->owners.push_back(codes[i]);
        if (codes.size() > 1) merge(shader->merged, code.reflection, code.name);
    }
    if (codes.size() > 1) {
        shader->reflection.bindings = shader->merged.bindings;
        shader->reflection.constants = shader->merged.constants;
    }
    return shader;
}

}  // namespace

FrameGraph::Impl::Impl(GraphOptions chosen) : options(std::move(chosen)) {
    if (options.framesInFlight < 1 || options.framesInFlight > 8)
        throw Error(formatText("a frame graph has 1 to 8 frames in flight, not {}", options.framesInFlight));
}
FrameGraph::Impl::~Impl() = default;

void FrameGraph::Impl::requireRecording() const {
    if (frame.number == 0) throw Error("the frame graph has no frame yet: call beginFrame() first");
    if (frame.executed) throw Error("the frame has been executed: call beginFrame() before recording more");
}

/// Only an executed frame passes its histories on; one that was only recorded leaves no trace.
void FrameGraph::Impl::commitHistories() {
    if (!frame.executed) return;
    for (auto& [name, state] : histories) {
        const auto recorded = recordedHistories.find(name);
        if (recorded == recordedHistories.end()) {
            state.valid = false;
            continue;
        }
        const RecordedImage& current = frame.images[recorded->second];
        state.format = current.key.format;
        state.backing = current.key.backing;
        state.extent = current.extent();
        state.currentHalf = current.key.half;
        state.valid = current.written;
    }
    std::erase_if(histories, [&](const auto& entry) { return !recordedHistories.contains(entry.first); });
}

void FrameGraph::Impl::claimName(const std::string& name) {
    if (name.empty()) throw Error("an image needs a name");
    if (!names.insert(name).second) throw Error(formatText("image '{}' is created twice in one frame", name));
}

ImageHandle FrameGraph::Impl::addImage(RecordedImage image) {
    if (image.key.width == 0 || image.key.height == 0) {
        throw Error(
            formatText("image '{}' is empty: {} x {} pixels", image.name, image.key.width, image.key.height));
    }
    const uint32_t index = static_cast<uint32_t>(frame.images.size());
    if (index >= indexMask) throw Error("too many images in one frame");
    frame.images.push_back(std::move(image));
    imageUses.emplace_back();
    return {index | generation(frame.number) << indexBits};
}

uint32_t FrameGraph::Impl::indexOf(ImageHandle handle) const {
    if (!handle) throw Error("the image handle is empty");
    const uint32_t index = handle.index & indexMask;
    if (handle.index >> indexBits != generation(frame.number) || index >= frame.images.size()) {
        throw Error("the image handle is from an earlier frame, or of another graph");
    }
    return index;
}

std::shared_ptr<const ShaderCode> FrameGraph::Impl::replaced(const ShaderCode& code) const {
    if (replacements) {
        const auto found = replacements->find(code.name);
        if (found != replacements->end()) return found->second;
    }
    return {CodePointer(), &code};
}

/// Compares the code itself: the viewer may load changed code under the same name.
std::shared_ptr<const Shader> FrameGraph::Impl::shaderOf(const ShaderCode& code, const RayShaders* rays) {
    std::array<CodePointer, rayStages.size()> all{replaced(code)};
    if (rays) all = {all[0], replaced(rays->miss), replaced(rays->closestHit), replaced(rays->anyHit)};
    const std::span<const CodePointer> codes = std::span(all).first(rays ? all.size() : 1);
    const auto found = shaders.find(code.name);
    if (found != shaders.end() && sameCode(*found->second, codes)) return found->second;
    const std::shared_ptr<const Shader> shader = makeShader(codes);
    shaders.insert_or_assign(std::string(code.name), shader);
    return shader;
}

void FrameGraph::setReplacements(const ShaderReplacements* replacements) {
    impl_->replacements = replacements;
}

std::vector<ShaderCode> FrameGraph::usedShaders() const {
    std::vector<ShaderCode> codes;
    for (const auto& [name, shader] : impl_->shaders)
        codes.insert(codes.end(), shader->stages.begin(), shader->stages.end());
    return codes;
}

FrameGraph::FrameGraph(GraphOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
FrameGraph::~FrameGraph() = default;

void FrameGraph::beginFrame() {
    impl_->commitHistories();
    if (std::exchange(impl_->resetRequested, false)) impl_->histories.clear();
    const uint64_t number = impl_->frame.number + 1;
    std::vector<std::byte> uploadData;
    if (!impl_->frame.uploadData.empty()) uploadData.swap(impl_->frame.uploadData);
    uploadData.clear();
    impl_->frame = {};
    impl_->frame.uploadData = std::move(uploadData);  // growing it anew would cost more than the copies
    impl_->frame.number = number;
    impl_->names.clear();
    impl_->recordedHistories.clear();
    impl_->imageUses.clear();
    impl_->bufferUses.clear();
    impl_->lastBarrier = 0;
}

ImageHandle FrameGraph::transient(const std::string& name, Format format, Extent extent, Backing backing) {
    impl_->requireRecording();
    impl_->claimName(name);
    return impl_->addImage({.name = name, .key = {name, 0, format, extent.width, extent.height, backing}});
}

History FrameGraph::history(const std::string& name, Format format, Extent extent, Backing backing) {
    impl_->requireRecording();
    const std::string previousName = name + " (previous)";
    impl_->claimName(name);
    impl_->claimName(previousName);
    HistoryState& state = impl_->histories[name];
    const bool valid =
        state.valid && state.format == format && state.extent == extent && state.backing == backing;
    const uint32_t half = state.currentHalf;
    History result;
    result.valid = valid;
    result.previous = impl_->addImage({.name = previousName,
                                       .key = {name, half, format, extent.width, extent.height, backing},
                                       .role = RecordedImage::Role::Previous,
                                       .clear = !valid});
    result.current = impl_->addImage({.name = name,
                                      .key = {name, half ^ 1, format, extent.width, extent.height, backing},
                                      .role = RecordedImage::Role::Current,
                                      .clear = !valid});
    impl_->recordedHistories[name] = impl_->indexOf(result.current);
    return result;
}

ImageHandle FrameGraph::import(const std::string& name, Format format, Extent extent,
                               const ForeignImage& foreign) {
    impl_->requireRecording();
    impl_->claimName(name);
    if (foreign.image == 0 || foreign.view == 0)
        throw Error(formatText("image '{}' is imported without a handle", name));
    return impl_->addImage({.name = name,
                            .key = {name, 0, format, extent.width, extent.height, Backing::Image},
                            .role = RecordedImage::Role::Foreign,
                            .foreign = foreign,
                            .written = true});
}

void FrameGraph::resetHistories() {
    impl_->resetRequested = true;
}

Extent FrameGraph::extent(ImageHandle image) const {
    return impl_->frame.images[impl_->indexOf(image)].extent();
}

Format FrameGraph::format(ImageHandle image) const {
    return impl_->frame.images[impl_->indexOf(image)].key.format;
}

Backing FrameGraph::backing(ImageHandle image) const {
    return impl_->frame.images[impl_->indexOf(image)].key.backing;
}

const std::string& FrameGraph::name(ImageHandle image) const {
    return impl_->frame.images[impl_->indexOf(image)].name;
}

void FrameGraph::dispatch(const Dispatch& dispatch) {
    impl_->requireRecording();
    DispatchRecorder(*impl_, dispatch).record();
}

void FrameGraph::upload(const Buffer& buffer, uint64_t offset, std::span<const std::byte> data) {
    impl_->requireRecording();
    if (!buffer) throw Error("an upload needs a buffer");
    const std::shared_ptr<const BufferResource>& storage = buffer.resource();
    if (offset % 4 != 0 || data.size() % 4 != 0 || offset > storage->size ||
        data.size() > storage->size - offset) {
        throw Error(formatText("an upload of {} bytes at {} does not fit buffer '{}' of {} bytes",
                               data.size(), offset, storage->name, storage->size));
    }
    if (data.empty()) return;
    impl_->frame.add({.buffer = storage, .offset = offset}, data, true);
}

void FrameGraph::upload(ImageHandle image, std::span<const std::byte> pixels) {
    impl_->frame.add({.image = impl_->uploadTarget(image, pixels.size())}, pixels, true);
}

void FrameGraph::uploadBorrowed(ImageHandle image, std::span<const std::byte> pixels) {
    impl_->frame.add({.image = impl_->uploadTarget(image, pixels.size())}, pixels, false);
}

uint32_t FrameGraph::Impl::uploadTarget(ImageHandle handle, size_t bytes) {
    requireRecording();
    const uint32_t index = indexOf(handle);
    RecordedImage& image = frame.images[index];
    if (image.role != RecordedImage::Role::Transient || image.written)
        throw Error(formatText("image '{}' cannot be uploaded: it is a history, or written", image.name));
    if (bytes != image.bytes()) {
        throw Error(
            formatText("image '{}' has {} bytes, but {} are uploaded", image.name, image.bytes(), bytes));
    }
    image.written = image.uploaded = true;
    return index;
}

void FrameGraph::place(const AccelerationStructures& structures, uint32_t placement,
                       const TreePlacement& where) {
    impl_->requireRecording();
    const StructuresResource& storage = *structures.resource();
    const StructuresResource::InstanceRecord bytes = storage.instanceRecord(placement, where);
    impl_->frame.add({.buffer = storage.instances, .offset = uint64_t{placement} * bytes.size()}, bytes,
                     true);
}

void FrameGraph::rebuild(std::string_view pass, const AccelerationStructures& structures) {
    impl_->requireRecording();
    const std::shared_ptr<const StructuresResource>& storage = structures.resource();
    RecordedPass recorded;
    recorded.name = pass;
    const std::array<Access, 2> accesses{
        Access{.buffer = storage->triangles.get(), .name = storage->triangles->name, .reads = true},
        Access{.buffer = storage->topBuffer.get(), .name = storage->topBuffer->name, .writes = true}};
    impl_->noteAccesses(recorded, accesses);
    RecordedDispatch dispatch;
    dispatch.resources.push_back(
        {.kind = BindingKind::AccelerationStructure, .buffer = storage->topBuffer, .structures = storage});
    impl_->frame.passes.push_back(std::move(recorded));
    impl_->frame.dispatches.push_back(std::move(dispatch));
}

void FrameGraph::host(HostPass pass) {
    impl_->requireRecording();
    RecordedPass recorded;
    recorded.name = pass.pass;
    RecordedDispatch dispatch;
    std::vector<Access> accesses;
    const auto add = [&](ImageHandle handle, bool writes) {
        const uint32_t index = impl_->indexOf(handle);
        const RecordedImage& image = impl_->frame.images[index];
        if (image.key.backing != Backing::Buffer)
            throw Error(formatText("pass '{}': the host cannot see image '{}', which is not in a buffer",
                                   pass.pass, image.name));
        if (!writes && !image.written && image.role != RecordedImage::Role::Previous)
            throw Error(formatText("pass '{}': nothing has written image '{}'", pass.pass, image.name));
        accesses.push_back({.image = index, .name = image.name, .reads = !writes, .writes = writes});
        dispatch.hostImages.push_back(index);
        recorded.imageBytes += image.bytes();
    };
    for (const ImageHandle handle : pass.reads) add(handle, false);
    for (const ImageHandle handle : pass.writes) add(handle, true);
    impl_->noteAccesses(recorded, accesses);
    dispatch.host = std::move(pass.run);
    impl_->frame.passes.push_back(std::move(recorded));
    impl_->frame.dispatches.push_back(std::move(dispatch));
}

uint64_t FrameGraph::largestBufferBytes() const {
    uint64_t bytes = 0;
    for (const RecordedImage& image : impl_->frame.images)
        if (image.key.backing == Backing::Buffer) bytes = std::max(bytes, image.bytes());
    return bytes;
}

uint64_t FrameGraph::imageBytes() const {
    const std::vector<uint32_t> memory = impl_->planMemory();
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < memory.size(); ++i) {
        const RecordedImage& image = impl_->frame.images[i];
        if (image.role != RecordedImage::Role::Foreign && memory[i] == i) bytes += image.bytes();
    }
    return bytes;
}

const std::vector<RecordedPass>& FrameGraph::passes() const {
    return impl_->frame.passes;
}

uint64_t FrameGraph::bytesOfImagesWrittenFrom(size_t first) const {
    std::set<std::string_view> written;
    for (size_t i = first; i < impl_->frame.passes.size(); ++i)
        written.insert(impl_->frame.passes[i].writes.begin(), impl_->frame.passes[i].writes.end());
    const std::vector<uint32_t> memory = impl_->planMemory();
    std::set<uint32_t> used;
    for (uint32_t i = 0; i < memory.size(); ++i) {
        const RecordedImage& image = impl_->frame.images[i];
        if (!written.contains(image.name)) continue;
        used.insert(memory[i]);
        if (image.role == RecordedImage::Role::Current) used.insert(i - 1);
    }
    uint64_t bytes = 0;
    for (const uint32_t i : used) bytes += impl_->frame.images[i].bytes();
    return bytes;
}

namespace {

/// Returns the frame's images in the list `names` of passes with this name.
std::vector<ImageHandle> imagesTouched(const RecordedFrame& frame, std::string_view pass,
                                       std::vector<std::string> RecordedPass::*names) {
    std::vector<ImageHandle> images;
    for (uint32_t i = 0; i < frame.images.size(); ++i) {
        const bool touches = std::ranges::any_of(frame.passes, [&](const RecordedPass& p) {
            return p.name == pass && std::ranges::find(p.*names, frame.images[i].name) != (p.*names).end();
        });
        if (touches) images.push_back({i | generation(frame.number) << indexBits});
    }
    return images;
}

}  // namespace

std::vector<ImageHandle> FrameGraph::imagesWrittenBy(std::string_view pass) const {
    return imagesTouched(impl_->frame, pass, &RecordedPass::writes);
}

std::vector<ImageHandle> FrameGraph::previousReadBy(std::string_view pass) const {
    std::vector<ImageHandle> images = imagesTouched(impl_->frame, pass, &RecordedPass::reads);
    std::erase_if(images, [&](ImageHandle image) {
        return impl_->frame.images[impl_->indexOf(image)].role != RecordedImage::Role::Previous;
    });
    return images;
}

void FrameGraph::assumeExecuted() {
    impl_->requireRecording();
    impl_->frame.executed = true;
}

}  // namespace limpid::gpu
