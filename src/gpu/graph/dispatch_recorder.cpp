#include "gpu/graph/dispatch_recorder.h"

#include <algorithm>
#include <array>
#include <optional>
#include <variant>

#include "base/error.h"
#include "base/text/format.h"

namespace limpid::gpu {
namespace {

std::string_view kindName(BindingKind kind) {
    switch (kind) {
        case BindingKind::StorageImage:
            return "image";
        case BindingKind::SampledImage:
            return "sampled image";
        case BindingKind::StorageTexelBuffer:
            return "texel buffer";
        case BindingKind::StorageBuffer:
            return "storage buffer";
        case BindingKind::UniformBuffer:
            return "uniform block";
        case BindingKind::AccelerationStructure:
            return "acceleration structure";
    }
    return "";
}

}  // namespace

DispatchRecorder::DispatchRecorder(FrameGraph::Impl& graph, const Dispatch& dispatch)
    : graph_(graph), dispatch_(dispatch), shader_(graph.shaderOf(dispatch.shader, dispatch.rays)) {}

void DispatchRecorder::fail(const std::string& fault) const {
    throw Error(formatText("pass '{}' ({}): {}", dispatch_.pass, shader_->name, fault));
}

void DispatchRecorder::fail(std::string_view variable, const std::string& fault) const {
    fail(formatText("variable '{}': {}", variable, fault));
}

void DispatchRecorder::record() {
    if (dispatch_.pass.empty()) fail("a pass needs a name");
    for (const Binding& binding : dispatch_.bindings) bound_.push_back(bind(binding));
    checkComplete();
    checkAliases();
    checkParams();
    readConstants();
    computeGroups();
    pass_.name = dispatch_.pass;
    pass_.shader = shader_->name;
    std::vector<Access> accesses;
    for (const Bound& bound : bound_) {
        accesses.push_back({.buffer = bound.resource.buffer.get(),
                            .image = bound.resource.image,
                            .name = bound.name,
                            .reads = bound.variable->readable,
                            .writes = bound.variable->writable});
    }
    countImageBytes();
    graph_.noteAccesses(pass_, accesses);

    result_.shader = shader_;
    for (Bound& bound : bound_) result_.resources.push_back(std::move(bound.resource));
    if (result_.paramsSize != 0) {
        std::vector<std::byte>& params = graph_.frame.params;
        result_.paramsOffset = params.size();
        params.insert(params.end(), dispatch_.params.begin(), dispatch_.params.end());
    }
    graph_.frame.passes.push_back(std::move(pass_));
    graph_.frame.dispatches.push_back(std::move(result_));
}

/// Counts an image only once even if two variables read it.
void DispatchRecorder::countImageBytes() {
    for (auto bound = bound_.begin(); bound != bound_.end(); ++bound) {
        if (bound->resource.buffer) continue;
        const auto readsIt = [&](const Bound& b) {
            return !b.resource.buffer && b.resource.image == bound->resource.image && b.variable->readable;
        };
        const bool reads = readsIt(*bound) && std::none_of(bound_.begin(), bound, readsIt);
        pass_.imageBytes +=
            graph_.frame.images[bound->resource.image].bytes() * (reads + bound->variable->writable);
    }
}

DispatchRecorder::Bound DispatchRecorder::bind(const Binding& binding) const {
    Bound bound;
    bound.variable = shader_->reflection.find(binding.name);
    if (!bound.variable) fail(binding.name, "the shader declares no such variable");
    const bool twice =
        std::ranges::any_of(bound_, [&](const Bound& b) { return b.variable == bound.variable; });
    if (twice) fail(binding.name, "is bound twice");
    bound.resource.binding = bound.variable->binding;
    bound.resource.kind = bound.variable->kind;
    if (bound.variable->kind == BindingKind::UniformBuffer) {
        fail(binding.name, "is the uniform block, which is filled from `params`");
    }
    if (const ImageHandle* handle = std::get_if<ImageHandle>(&binding.resource)) {
        bindImage(bound, *handle);
    } else if (const auto* structures = std::get_if<const AccelerationStructures*>(&binding.resource)) {
        bindStructures(bound, *structures);
    } else {
        bindBuffer(bound, std::get<const Buffer*>(binding.resource));
    }
    return bound;
}

void DispatchRecorder::bindImage(Bound& bound, ImageHandle handle) const {
    const ShaderBinding& variable = *bound.variable;
    try {
        bound.resource.image = graph_.indexOf(handle);
    } catch (const Error& error) {
        fail(variable.name, error.what());
    }
    RecordedImage& image = graph_.frame.images[bound.resource.image];
    bound.name = image.name;
    if (variable.kind == BindingKind::SampledImage) return bindSampled(bound, image);
    if (image.sampled)
        fail(variable.name, formatText("'{}' is sampled by another pass of this frame", bound.name));
    const bool inBuffer = image.key.backing == Backing::Buffer;
    if (inBuffer && variable.kind == BindingKind::StorageImage)
        fail(variable.name, "is an image in the shader, but what is bound lies in a buffer");
    if (variable.kind != (inBuffer ? BindingKind::StorageBuffer : BindingKind::StorageImage)) {
        fail(variable.name,
             formatText("is a {} in the shader, but an image is bound", kindName(variable.kind)));
    }
    if (!inBuffer && image.key.format != variable.format) {
        fail(variable.name, formatText("is {} in the shader, but image '{}' is {}", toString(variable.format),
                                       image.name, toString(image.key.format)));
    }
    const bool previous = image.role == RecordedImage::Role::Previous;
    if (previous && variable.writable) {
        fail(variable.name, formatText("would write '{}', but a history's previous image can only be read: "
                                       "declare the variable readonly, or bind the current one",
                                       image.name));
    }
    if (!previous && variable.readable && !image.written) {
        fail(variable.name,
             formatText("reads image '{}', which no pass of this frame has written{}", image.name,
                        variable.writable ? " (declare the variable writeonly if it only writes)" : ""));
    }
    image.stored = image.role == RecordedImage::Role::Foreign;
}

/// Texels of any format are read as four floats or four unsigned integers.
void DispatchRecorder::bindSampled(const Bound& bound, RecordedImage& image) const {
    const ShaderBinding& variable = *bound.variable;
    if (image.key.backing == Backing::Buffer)
        fail(variable.name, "is sampled in the shader, but what is bound lies in a buffer");
    if (hasUnsignedComponents(image.key.format) != hasUnsignedComponents(variable.format))
        fail(variable.name, formatText("samples {} in the shader, but image '{}' is {}",
                                       toString(variable.format), image.name, toString(image.key.format)));
    if (!image.written && image.role != RecordedImage::Role::Previous)
        fail(variable.name,
             formatText("reads image '{}', which no pass of this frame has written", image.name));
    if (image.stored) fail(variable.name, formatText("'{}' is a storage image in another pass", image.name));
    image.sampled = image.role == RecordedImage::Role::Foreign;
}

void DispatchRecorder::bindBuffer(Bound& bound, const Buffer* buffer) const {
    const ShaderBinding& variable = *bound.variable;
    if (variable.kind == BindingKind::StorageImage)
        fail(variable.name, "is an image in the shader, but a buffer is bound");
    if (variable.kind == BindingKind::AccelerationStructure)
        fail(variable.name, "is an acceleration structure in the shader, but a buffer is bound");
    if (!buffer || !*buffer) fail(variable.name, "the buffer is empty");
    bound.resource.buffer = buffer->resource();
    bound.name = bound.resource.buffer->name;
    const std::optional<Format> format = buffer->texelFormat();
    const BindingKind kind = format ? BindingKind::StorageTexelBuffer : BindingKind::StorageBuffer;
    if (kind != variable.kind) {
        fail(variable.name, formatText("is a {} in the shader, but '{}' is a {}", kindName(variable.kind),
                                       bound.name, kindName(kind)));
    }
    if (format && *format != variable.format) {
        fail(variable.name, formatText("is {} in the shader, but texel buffer '{}' is {}",
                                       toString(variable.format), bound.name, toString(*format)));
    }
}

void DispatchRecorder::bindStructures(Bound& bound, const AccelerationStructures* structures) const {
    const ShaderBinding& variable = *bound.variable;
    if (variable.kind != BindingKind::AccelerationStructure) {
        fail(variable.name, formatText("is a {} in the shader, but an acceleration structure is bound",
                                       kindName(variable.kind)));
    }
    bound.resource.structures = structures->resource();
    bound.resource.buffer = bound.resource.structures->topBuffer;
    bound.name = bound.resource.buffer->name;
}

void DispatchRecorder::checkComplete() const {
    for (const ShaderBinding& variable : shader_->reflection.bindings) {
        if (variable.kind == BindingKind::UniformBuffer) continue;
        const bool there =
            std::ranges::any_of(bound_, [&](const Bound& b) { return b.variable == &variable; });
        if (!there) fail(variable.name, formatText("nothing is bound to this {}", kindName(variable.kind)));
    }
}

/// No barrier helps within one dispatch: a read while another thread writes may return either value.
void DispatchRecorder::checkAliases() const {
    for (size_t i = 0; i < bound_.size(); ++i) {
        for (size_t j = 0; j < i; ++j) {
            const BoundResource& a = bound_[i].resource;
            const BoundResource& b = bound_[j].resource;
            const bool same = a.buffer == b.buffer && (a.buffer || a.image == b.image);
            if (same && (bound_[i].variable->writable || bound_[j].variable->writable)) {
                fail(bound_[i].variable->name,
                     formatText("'{}' is also bound to '{}', and one of the two can write it", bound_[i].name,
                                bound_[j].variable->name));
            }
        }
    }
}

void DispatchRecorder::checkParams() {
    const auto& bindings = shader_->reflection.bindings;
    const auto block = std::ranges::find(bindings, BindingKind::UniformBuffer, &ShaderBinding::kind);
    const size_t given = dispatch_.params.size();
    if (block == bindings.end()) {
        if (given != 0) fail(formatText("params has {} bytes, but the shader has no uniform block", given));
        return;
    }
    if (given != block->blockSize) {
        fail(block->name,
             formatText("the uniform block has {} bytes, but params has {}", block->blockSize, given));
    }
    result_.paramsBinding = block->binding;
    result_.paramsSize = given;
}

void DispatchRecorder::readConstants() {
    for (const ConstantValue& value : dispatch_.constants) {
        const auto& constants = shader_->reflection.constants;
        const auto constant = std::ranges::find(constants, value.name, &ShaderConstant::name);
        if (constant == constants.end()) {
            fail(
                formatText("constant '{}': the shader declares no such specialisation constant", value.name));
        }
        result_.constants.emplace_back(constant->id, value.value);
    }
    std::ranges::sort(result_.constants);
    const auto again =
        std::ranges::adjacent_find(result_.constants, {}, &std::pair<uint32_t, uint32_t>::first);
    if (again != result_.constants.end()) {
        fail(formatText("the specialisation constant of id {} is set twice", again->first));
    }
}

void DispatchRecorder::computeGroups() {
    if (dispatch_.extent.width == 0 || dispatch_.extent.height == 0) {
        fail(formatText("the extent is empty: {} x {} threads", dispatch_.extent.width,
                        dispatch_.extent.height));
    }
    const std::array<uint32_t, 3> threads{dispatch_.extent.width, dispatch_.extent.height, 1};
    std::array<uint32_t, 3> size = shader_->reflection.workgroupSize;
    if (shader_->tracesRays()) size = {1, 1, 1};
    for (const auto& [id, value] : result_.constants) {
        for (size_t axis = 0; axis < 3; ++axis) {
            if (shader_->reflection.workgroupSizeIds[axis] == id) size[axis] = value;
        }
    }
    if (std::ranges::find(size, 0u) != size.end()) fail("a constant makes the workgroup empty");
    for (size_t axis = 0; axis < 3; ++axis) {
        result_.groups[axis] = threads[axis] / size[axis] + (threads[axis] % size[axis] != 0 ? 1 : 0);
    }
    result_.workgroupSize = size;
    pass_.groups = result_.groups;
}

}  // namespace limpid::gpu
