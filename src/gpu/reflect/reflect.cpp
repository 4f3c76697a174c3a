#include "gpu/reflect/reflect.h"

#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>
#include <array>
#include <deque>
#include <optional>

#include "base/error.h"
#include "gpu/reflect/shader_hash.h"
#include "gpu/reflect/spirv_declarations.h"

namespace limpid::gpu {
namespace {

/// Builds messages without fmt: the build tool links only SPIRV-Cross.
template <typename... Parts>
std::string joined(const Parts&... parts) {
    std::string text;
    (text.append(std::string_view(parts)), ...);
    return text;
}

/// A shader and all the data that its `code` views.
struct OwnedShader {
    std::string name;
    std::vector<uint32_t> words;
    std::deque<std::string> names;  ///< of variables and constants; a deque does not move them when it grows
    std::vector<ShaderBinding> bindings;
    std::vector<ShaderConstant> constants;
    ShaderCode code;
};

struct ContextDeleter {
    void operator()(spvc_context context) const { spvc_context_destroy(context); }
};

std::optional<Format> toFormat(SpvImageFormat format) {
    switch (format) {
        case SpvImageFormatR32f:
            return Format::R32Float;
        case SpvImageFormatR32ui:
            return Format::R32Uint;
        case SpvImageFormatRg32f:
            return Format::RG32Float;
        case SpvImageFormatRg32ui:
            return Format::RG32Uint;
        case SpvImageFormatRgba32f:
            return Format::RGBA32Float;
        case SpvImageFormatRgba32ui:
            return Format::RGBA32Uint;
        case SpvImageFormatR16f:
            return Format::R16Float;
        case SpvImageFormatRgba16f:
            return Format::RGBA16Float;
        case SpvImageFormatRgba8:
            return Format::RGBA8Unorm;
        default:
            return std::nullopt;
    }
}

/// Runs SPIRV-Cross on one shader.
class Reflector {
  public:
    /// Reads the words of `shader` and fills in the rest.
    explicit Reflector(OwnedShader& shader);
    void run();

  private:
    using List = std::span<const spvc_reflected_resource>;

    [[noreturn]] void fail(const std::string& fault) const;
    void check(spvc_result result) const;
    List list(spvc_resource_type type) const;
    void refuse(spvc_resource_type type, std::string_view what) const;

    ShaderBinding common(const spvc_reflected_resource& resource, std::string name) const;
    std::string blockName(const spvc_reflected_resource& resource) const;
    ShaderBinding image(const spvc_reflected_resource& resource) const;
    ShaderBinding storageBuffer(const spvc_reflected_resource& resource) const;
    ShaderBinding uniformBlock(const spvc_reflected_resource& resource) const;
    bool everyMemberHas(const spvc_reflected_resource& resource, SpvDecoration decoration) const;
    void readBindings();
    void checkNumbers() const;
    void readConstants();
    void readWorkgroupSize(ShaderReflection& reflection) const;

    ShaderStage stageOf(SpvExecutionModel model) const;
    ShaderBinding sampledImage(const spvc_reflected_resource& resource) const;
    ShaderBinding accelerationStructure(const spvc_reflected_resource& resource) const;

    OwnedShader& shader_;
    ShaderStage stage_{};
    std::unique_ptr<spvc_context_s, ContextDeleter> context_;
    spvc_compiler compiler_ = nullptr;
    spvc_resources resources_ = nullptr;
};

Reflector::Reflector(OwnedShader& shader) : shader_(shader) {
    spvc_context context = nullptr;
    if (spvc_context_create(&context) != SPVC_SUCCESS) fail("SPIRV-Cross ran out of memory");
    context_.reset(context);
    spvc_parsed_ir ir = nullptr;
    const std::vector<uint32_t> words = withoutCooperativeMatrices(shader.words);
    check(spvc_context_parse_spirv(context, words.data(), words.size(), &ir));
    check(spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                       &compiler_));
    stage_ = stageOf(spvc_compiler_get_execution_model(compiler_));
    check(spvc_compiler_create_shader_resources(compiler_, &resources_));
}

void Reflector::fail(const std::string& fault) const {
    throw Error(joined("shader '", shader_.name, "': ", fault));
}

void Reflector::check(spvc_result result) const {
    if (result == SPVC_SUCCESS) return;
    fail(joined("SPIRV-Cross cannot read it: ", spvc_context_get_last_error_string(context_.get())));
}

Reflector::List Reflector::list(spvc_resource_type type) const {
    const spvc_reflected_resource* first = nullptr;
    size_t count = 0;
    check(spvc_resources_get_resource_list_for_type(resources_, type, &first, &count));
    return {first, count};
}

void Reflector::refuse(spvc_resource_type type, std::string_view what) const {
    const List found = list(type);
    if (!found.empty()) fail(joined("variable '", found[0].name, "': Limpid has no ", what));
}

/// Reads the properties common to all resources: the binding number and set; rejects arrays.
ShaderBinding Reflector::common(const spvc_reflected_resource& resource, std::string name) const {
    if (name.empty()) fail("a variable has no name (was the SPIR-V stripped or optimised?)");
    ShaderBinding result;
    result.name = shader_.names.emplace_back(std::move(name));
    if (spvc_compiler_get_decoration(compiler_, resource.id, SpvDecorationDescriptorSet) != 0) {
        fail(joined("variable '", result.name, "': only descriptor set 0 is supported"));
    }
    if (!spvc_compiler_has_decoration(compiler_, resource.id, SpvDecorationBinding)) {
        fail(joined("variable '", result.name, "' has no layout(binding = ...)"));
    }
    result.binding = spvc_compiler_get_decoration(compiler_, resource.id, SpvDecorationBinding);
    if (spvc_type_get_num_array_dimensions(spvc_compiler_get_type_handle(compiler_, resource.type_id)) != 0) {
        fail(joined("variable '", result.name, "': arrays of resources are not supported"));
    }
    result.readable = !spvc_compiler_has_decoration(compiler_, resource.id, SpvDecorationNonReadable);
    result.writable = !spvc_compiler_has_decoration(compiler_, resource.id, SpvDecorationNonWritable);
    return result;
}

std::string Reflector::blockName(const spvc_reflected_resource& resource) const {
    const std::string instance = spvc_compiler_get_name(compiler_, resource.id);
    return instance.empty() ? spvc_compiler_get_name(compiler_, resource.base_type_id) : instance;
}

ShaderBinding Reflector::image(const spvc_reflected_resource& resource) const {
    ShaderBinding result = common(resource, spvc_compiler_get_name(compiler_, resource.id));
    const spvc_type type = spvc_compiler_get_type_handle(compiler_, resource.type_id);
    const SpvDim dimension = spvc_type_get_image_dimension(type);
    if (dimension == SpvDimBuffer) {
        result.kind = BindingKind::StorageTexelBuffer;
    } else if (dimension == SpvDim2D && !spvc_type_get_image_arrayed(type) &&
               !spvc_type_get_image_multisampled(type)) {
        result.kind = BindingKind::StorageImage;
    } else {
        fail(joined("variable '", result.name, "': images are two-dimensional or buffers here"));
    }
    const std::optional<Format> format = toFormat(spvc_type_get_image_storage_format(type));
    if (!format) {
        fail(joined(
            "variable '", result.name,
            "' needs one of the formats r32f, r32ui, rg32f, rg32ui, rgba32f, rgba32ui, rgba16f, rgba8"));
    }
    result.format = *format;
    return result;
}

/// texture2D and utexture2D. They have no declared format, only float or unsigned components.
ShaderBinding Reflector::sampledImage(const spvc_reflected_resource& resource) const {
    ShaderBinding result = common(resource, spvc_compiler_get_name(compiler_, resource.id));
    const std::string name(result.name);
    result.kind = BindingKind::SampledImage;
    result.readable = true;
    result.writable = false;
    const spvc_type type = spvc_compiler_get_type_handle(compiler_, resource.type_id);
    if (spvc_type_get_image_dimension(type) != SpvDim2D || spvc_type_get_image_arrayed(type) ||
        spvc_type_get_image_multisampled(type))
        fail("variable '" + name + "': sampled images are two-dimensional here");
    const spvc_type component =
        spvc_compiler_get_type_handle(compiler_, spvc_type_get_image_sampled_type(type));
    const spvc_basetype base = spvc_type_get_basetype(component);
    if (base != SPVC_BASETYPE_FP32 && base != SPVC_BASETYPE_UINT32)
        fail("variable '" + name + "': sampled images have floats or unsigned integers here");
    result.format = base == SPVC_BASETYPE_FP32 ? Format::RGBA32Float : Format::RGBA32Uint;
    return result;
}

ShaderBinding Reflector::accelerationStructure(const spvc_reflected_resource& resource) const {
    ShaderBinding result = common(resource, spvc_compiler_get_name(compiler_, resource.id));
    result.kind = BindingKind::AccelerationStructure;
    result.readable = true;
    result.writable = false;
    return result;
}

ShaderStage Reflector::stageOf(SpvExecutionModel model) const {
    switch (model) {
        case SpvExecutionModelGLCompute:
            return ShaderStage::Compute;
        case SpvExecutionModelRayGenerationKHR:
            return ShaderStage::RayGeneration;
        case SpvExecutionModelMissKHR:
            return ShaderStage::Miss;
        case SpvExecutionModelClosestHitKHR:
            return ShaderStage::ClosestHit;
        case SpvExecutionModelAnyHitKHR:
            return ShaderStage::AnyHit;
        default:
            fail("is of a stage that Limpid does not use");
    }
}

bool Reflector::everyMemberHas(const spvc_reflected_resource& resource, SpvDecoration decoration) const {
    const spvc_type type = spvc_compiler_get_type_handle(compiler_, resource.base_type_id);
    const unsigned members = spvc_type_get_num_member_types(type);
    for (unsigned i = 0; i < members; ++i) {
        if (!spvc_compiler_has_member_decoration(compiler_, resource.base_type_id, i, decoration))
            return false;
    }
    return members > 0;
}

/// A block's readonly and writeonly are on its members, not on the variable.
ShaderBinding Reflector::storageBuffer(const spvc_reflected_resource& resource) const {
    ShaderBinding result = common(resource, blockName(resource));
    result.kind = BindingKind::StorageBuffer;
    if (everyMemberHas(resource, SpvDecorationNonReadable)) result.readable = false;
    if (everyMemberHas(resource, SpvDecorationNonWritable)) result.writable = false;
    return result;
}

ShaderBinding Reflector::uniformBlock(const spvc_reflected_resource& resource) const {
    ShaderBinding result = common(resource, blockName(resource));
    result.kind = BindingKind::UniformBuffer;
    result.writable = false;
    const spvc_type type = spvc_compiler_get_type_handle(compiler_, resource.base_type_id);
    size_t size = 0;
    check(spvc_compiler_get_declared_struct_size(compiler_, type, &size));
    result.blockSize = static_cast<uint32_t>(size);
    return result;
}

void Reflector::readBindings() {
    std::vector<ShaderBinding>& bindings = shader_.bindings;
    for (const auto& r : list(SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE))
        bindings.push_back(accelerationStructure(r));
    for (const auto& r : list(SPVC_RESOURCE_TYPE_STORAGE_IMAGE)) bindings.push_back(image(r));
    for (const auto& r : list(SPVC_RESOURCE_TYPE_SEPARATE_IMAGE)) bindings.push_back(sampledImage(r));
    for (const auto& r : list(SPVC_RESOURCE_TYPE_STORAGE_BUFFER)) bindings.push_back(storageBuffer(r));
    const List uniforms = list(SPVC_RESOURCE_TYPE_UNIFORM_BUFFER);
    for (const auto& r : uniforms) bindings.push_back(uniformBlock(r));
    if (uniforms.size() > 1) fail("it has more than one uniform block");
    std::ranges::sort(bindings, {}, &ShaderBinding::binding);
    checkNumbers();
}

void Reflector::checkNumbers() const {
    const auto same =
        std::ranges::adjacent_find(shader_.bindings, std::ranges::equal_to{}, &ShaderBinding::binding);
    if (same == shader_.bindings.end()) return;
    fail(joined("variables '", same->name, "' and '", std::next(same)->name, "' share binding ",
                std::to_string(same->binding)));
}

void Reflector::readConstants() {
    const spvc_specialization_constant* constants = nullptr;
    size_t count = 0;
    check(spvc_compiler_get_specialization_constants(compiler_, &constants, &count));
    for (const spvc_specialization_constant& constant : std::span(constants, count)) {
        const std::string name = spvc_compiler_get_name(compiler_, constant.id);
        if (name.empty()) continue;  // created by the compiler for layout(local_size_x_id = ...)
        const spvc_constant handle = spvc_compiler_get_constant_handle(compiler_, constant.id);
        const spvc_type type = spvc_compiler_get_type_handle(compiler_, spvc_constant_get_type(handle));
        const bool isBool = spvc_type_get_basetype(type) == SPVC_BASETYPE_BOOLEAN;
        if (!isBool && spvc_type_get_bit_width(type) != 32) {
            fail(joined("constant '", name, "' has no 32 bits"));
        }
        const auto other = std::ranges::find(shader_.constants, constant.constant_id, &ShaderConstant::id);
        if (other != shader_.constants.end()) {
            fail(joined("constants '", other->name, "' and '", name, "' share id ",
                        std::to_string(other->id)));
        }
        shader_.constants.push_back({shader_.names.emplace_back(name), constant.constant_id});
    }
}

void Reflector::readWorkgroupSize(ShaderReflection& reflection) const {
    std::array<spvc_specialization_constant, 3> ids{};
    spvc_compiler_get_work_group_size_specialization_constants(compiler_, &ids[0], &ids[1], &ids[2]);
    for (unsigned axis = 0; axis < 3; ++axis) {
        if (ids[axis].id == 0) {
            reflection.workgroupSize[axis] = spvc_compiler_get_execution_mode_argument_by_index(
                compiler_, SpvExecutionModeLocalSize, axis);
        } else {
            const spvc_constant constant = spvc_compiler_get_constant_handle(compiler_, ids[axis].id);
            reflection.workgroupSize[axis] = spvc_constant_get_scalar_u32(constant, 0, 0);
            reflection.workgroupSizeIds[axis] = ids[axis].constant_id;
        }
        if (reflection.workgroupSize[axis] == 0) fail("its workgroup size cannot be read");
    }
}

void Reflector::run() {
    refuse(SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, "images with samplers");
    refuse(SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, "samplers");
    refuse(SPVC_RESOURCE_TYPE_PUSH_CONSTANT, "push constants");
    refuse(SPVC_RESOURCE_TYPE_ATOMIC_COUNTER, "atomic counters");
    readBindings();
    readConstants();
    ShaderReflection reflection;
    reflection.stage = stage_;
    reflection.bindings = shader_.bindings;
    reflection.constants = shader_.constants;
    if (stage_ == ShaderStage::Compute) readWorkgroupSize(reflection);
    shader_.code = {shader_.name, shader_.words, reflection, hashOf(shader_.words, reflection)};
}

}  // namespace

std::shared_ptr<const ShaderCode> reflect(std::string name, std::vector<uint32_t> words) {
    const auto shader = std::make_shared<OwnedShader>();
    shader->name = std::move(name);
    shader->words = std::move(words);
    Reflector(*shader).run();
    return {shader, &shader->code};
}

}  // namespace limpid::gpu
