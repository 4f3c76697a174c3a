#include "denoise/api/instance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/text/format.h"
#include "denoise/api/camera_matrices.h"

namespace limpid::denoise {
namespace {

// limpid_method counts the methods in the order in which src/denoise/CMakeLists.txt lists them.
#define LIMPID_NAME(method) std::string_view(#method),
constexpr std::array methodNames{LIMPID_METHODS(LIMPID_NAME)};
#undef LIMPID_NAME
static_assert(methodNames[LIMPID_METHOD_SVGF] == "svgf" && methodNames[LIMPID_METHOD_ATROUS] == "atrous" &&
              methodNames[LIMPID_METHOD_TEMPORAL] == "temporal" &&
              methodNames[LIMPID_METHOD_BILATERAL] == "bilateral" &&
              methodNames[LIMPID_METHOD_VISIBILITY] == "visibility" &&
              methodNames[LIMPID_METHOD_NANO] == "nano" && methodNames[LIMPID_METHOD_FILM] == "film" &&
              methodNames.size() == LIMPID_METHOD_FILM + 1);

constexpr uint32_t mostSamples = 65536;

/// Calls `visit(table, settings)` for each group that the method reads.
template <typename Settings, typename Visit>
void forEachGroupOf(limpid_method method, Settings& settings, const Visit& visit) {
    const std::span<const std::string_view> groups = methods()[static_cast<size_t>(method)].groups;
    forEachGroup(settings, [&](const auto& table, auto& group) {
        if (std::ranges::find(groups, table.group()) != groups.end()) visit(table, group);
    });
}

std::vector<InstanceParameter> listOf(limpid_method method) {
    std::vector<InstanceParameter> all;
    FilterSettings settings;
    forEachGroupOf(method, settings, [&](const auto& table, auto&) { listParameters(table, all); });
    // limpid_denoiser_desc::signals says it.
    std::erase_if(all, [](const InstanceParameter& p) { return p.name == "svgf.separate"; });
    return all;
}

/// A C caller may pass any number as an enumerator, so check it as an integer.
template <typename Enum>
void checkEnum(const char* what, const Enum& given, int last) {
    int value = 0;
    static_assert(sizeof(given) == sizeof(value));
    std::memcpy(&value, &given, sizeof(value));
    if (value < 0 || value > last) throw UsageError(formatText("{}: invalid value {}", what, value));
}

void checkMethod(const limpid_method& method) {
    checkEnum("method", method, static_cast<int>(methods().size()) - 1);
}

void checkJitter(const limpid_camera& camera) {
    for (const float offset : camera.jitter)
        if (!(std::abs(offset) <= 0.5f))
            throw UsageError(formatText("jitter: {} is not from -0.5 to 0.5 pixels", offset));
}

/// Its `kind` and `reflections` follow from the frame's images.
MotionEncoding motionEncoding(const limpid_denoiser_desc& desc, const limpid_camera& camera,
                              const CameraMatrices& before, bool hasPrevious) {
    const float direction = desc.motion_direction == LIMPID_MOTION_TO_PREVIOUS ? 1.0f : -1.0f;
    const float downwards = desc.clip_y == LIMPID_CLIP_Y_UP ? -1.0f : 1.0f;
    const auto width = static_cast<float>(desc.width), height = static_cast<float>(desc.height);
    MotionEncoding encoding{};
    encoding.hasPrevious = hasPrevious ? 1u : 0u;
    encoding.toPixels = {direction, direction};
    if (desc.motion_unit == LIMPID_MOTION_UV) encoding.toPixels = {direction * width, direction * height};
    if (desc.motion_unit == LIMPID_MOTION_NDC)
        encoding.toPixels = {0.5f * direction * width, 0.5f * downwards * direction * height};
    encoding.toDistance = desc.motion_depth == LIMPID_MOTION_DISTANCE ? direction : 0.0f;
    encoding.jitter = {camera.jitter[0], camera.jitter[1]};
    encoding.previousCamera = before.params;
    encoding.previousClipX = before.clip[0];
    encoding.previousClipY = before.clip[1];
    encoding.previousClipW = before.clip[2];
    return encoding;
}

[[noreturn]] void failUnknown(std::string_view name) {
    throw UsageError(formatText("the method has no parameter '{}'", name));
}

}  // namespace

const std::vector<InstanceParameter>& parametersOf(limpid_method method) {
    static const std::vector<std::vector<InstanceParameter>> all = [] {
        std::vector<std::vector<InstanceParameter>> lists;
        for (size_t i = 0; i < methods().size(); ++i) lists.push_back(listOf(static_cast<limpid_method>(i)));
        return lists;
    }();
    checkMethod(method);
    return all[static_cast<size_t>(method)];
}

void setParameter(FilterSettings& settings, limpid_method method, std::string_view name, double value) {
    bool found = false;
    forEachGroupOf(method, settings, [&](const auto& table, auto& group) {
        found = found || setNumber(table, group, name, value);
    });
    if (!found) failUnknown(name);
}

double parameter(const FilterSettings& settings, limpid_method method, std::string_view name) {
    std::optional<double> result;
    forEachGroupOf(method, settings, [&](const auto& table, const auto& group) {
        if (!result) result = getNumber(table, group, name);
    });
    if (!result) failUnknown(name);
    return *result;
}

void check(const limpid_denoiser_desc& desc) {
    checkMethod(desc.method);
    checkEnum("normal_encoding", desc.normal_encoding, LIMPID_NORMAL_OCTAHEDRAL_UNORM);
    checkEnum("normal_space", desc.normal_space, LIMPID_SPACE_VIEW);
    checkEnum("depth", desc.depth, LIMPID_DEPTH_DEVICE);
    checkEnum("motion_unit", desc.motion_unit, LIMPID_MOTION_NDC);
    checkEnum("motion_direction", desc.motion_direction, LIMPID_MOTION_FROM_PREVIOUS);
    checkEnum("motion_depth", desc.motion_depth, LIMPID_MOTION_DISTANCE);
    checkEnum("clip_y", desc.clip_y, LIMPID_CLIP_Y_UP);
    if (desc.signals > 2) throw UsageError(formatText("signals must be 1 or 2, not {}", desc.signals));
    if (desc.signals == 2 && methods()[static_cast<size_t>(desc.method)].oneChannel)
        throw UsageError("signals must be 1 for the method 'visibility'");
    if (desc.width == 0 || desc.height == 0 || desc.width > 32768 || desc.height > 32768)
        throw UsageError(
            formatText("images of {} x {} pixels: each side has 1 to 32768", desc.width, desc.height));
    if (!(desc.far_depth >= 0.0f))
        throw UsageError(formatText("far_depth: {} is negative or not a number", desc.far_depth));
    if (desc.samples > mostSamples)
        throw UsageError(formatText("samples: at most {}, not {}", mostSamples, desc.samples));
    if (desc.frames_in_flight > 8)
        throw UsageError(formatText("frames_in_flight: at most 8, not {}", desc.frames_in_flight));
}

bool readsHistory(const limpid_denoiser_desc& desc, const FilterSettings& settings) {
    return methods()[static_cast<size_t>(desc.method)].keepsHistory ||
           framesToAverage(settings.taa, false) > 1.0f;
}

IngestParams ingestParams(const limpid_denoiser_desc& desc, const limpid_camera& camera, bool hasPrevious) {
    checkJitter(camera);
    const bool yUp = desc.clip_y == LIMPID_CLIP_Y_UP;
    const CameraMatrices now = cameraFromMatrices(camera.view, camera.projection, yUp, desc.height);
    const CameraMatrices before = hasPrevious
                                      ? cameraFromMatrices(camera.previous_view, camera.previous_projection,
                                                           yUp, desc.height, "previous_")
                                      : now;
    IngestParams params{};
    params.camera = now.params;
    params.motion = motionEncoding(desc, camera, before, hasPrevious);
    params.deviceDepth = now.deviceDepth;
    params.farDepth = desc.far_depth > 0.0f ? desc.far_depth : 1e9f;
    params.width = desc.width;
    params.height = desc.height;
    params.normals = {static_cast<uint>(desc.normal_encoding),
                      desc.normal_space == LIMPID_SPACE_VIEW ? 1u : 0u, now.axes[0], now.axes[1],
                      now.axes[2]};
    params.depthKind = static_cast<uint>(desc.depth);
    params.reversed = now.reversed ? 1u : 0u;
    return params;
}

InstanceOutputs recordFrame(gpu::FrameGraph& graph, const limpid_denoiser_desc& desc,
                            const FilterSettings& settings, const IngestImages& images,
                            const IngestParams& params, const gpu::FilterChoice& choice, bool signalsToo,
                            gpu::ImageHandle target) {
    IngestImages taken = images;
    if (desc.demodulated) taken.albedo = taken.albedoSpecular = {};
    FilterSettings used = settings;
    used.svgf.separate = desc.signals == 2;
    const Method& method = methods()[static_cast<size_t>(desc.method)];
    const bool antialiases = framesToAverage(used.taa, false) > 1.0f;
    DenoiserInput input = ingest(graph, taken, params,
                                 {.twoSignals = desc.signals == 2,
                                  .layers = method.readsLayers || antialiases,
                                  .albedo = !method.oneChannel,
                                  .samples = method.readsVariances ? desc.samples : 1,
                                  .filters = choice.backing});
    input.choose(choice);
    input.jitter = params.motion.jitter;
    // A jitter of 0 may also mean that edges are smooth already.
    const bool jittered = input.jitter.x != 0.0f || input.jitter.y != 0.0f;
    input.jitterChanges = antialiases && jittered;
    if (!antialiases && !used.temporal.showDisocclusion) input.target = target;
    input.wantsSignals = signalsToo;
    const DenoiserOutput made = method.record(graph, input, used);
    return {made.beauty, made.diffuse, made.specular};
}

const char* inputName(size_t input) {
    constexpr std::array<const char*, inputCount> names{"radiance",
                                                        "specular",
                                                        "emission",
                                                        "albedo",
                                                        "albedo_specular",
                                                        "normal",
                                                        "depth",
                                                        "motion",
                                                        "previous_normal",
                                                        "reflection_motion",
                                                        "id",
                                                        "roughness",
                                                        "hit_distance",
                                                        "radiance_variance",
                                                        "specular_variance"};
    return names.at(input);
}

}  // namespace limpid::denoise
