// The C interface (limpid/denoise.h): devices, denoisers, parameters.
#include <algorithm>
#include <array>
#include <utility>

#include "denoise/api/c_device.h"
#include "denoise/api/c_guard.h"
#include "denoise/api/c_handles.h"
#include "denoise/stages/output/output.h"

using namespace limpid;
using namespace limpid::denoise;

namespace {

/// Looks along -z and along +z: as matrices of a perspective and of an orthographic camera.
constexpr float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr float perspective[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.1f, 0};

/// Throws Unsupported if images of this size are too large for the device, or the buffers that hold some of
/// them.
void checkSize(const gpu::Device& device, const limpid_denoiser_desc& desc) {
    const auto check = [&](uint64_t needed, uint64_t most, const char* unit) {
        if (needed <= most) return;
        throw gpu::Unsupported(formatText("images of {} x {} pixels need {} {}; {} has at most {}",
                                          desc.width, desc.height, needed, unit, device.info().name, most));
    };
    check(std::max(desc.width, desc.height), device.maxImageSide(), "pixels in a side");
    gpu::FrameGraph dry;
    recordDryFrame(dry, desc, {}, gpu::filterChoice(device), {}, false);
    check(dry.largestBufferBytes(), device.maxStorageBufferBytes(), "bytes in a buffer");
}

}  // namespace

namespace limpid::denoise {

gpu::GraphOptions graphOptions(const limpid_denoiser_desc& desc) {
    return {.framesInFlight = desc.frames_in_flight == 0 ? 2 : desc.frames_in_flight,
            .prefix = desc.name ? desc.name : "limpid/",
            .timestamps = desc.timings != 0,
            .shareMemory = true};
}

gpu::ImageHandle& imageOf(IngestImages& images, size_t input) {
    constexpr std::array<gpu::ImageHandle IngestImages::*, inputCount> members{
        &IngestImages::radiance,
        &IngestImages::specular,
        &IngestImages::emission,
        &IngestImages::albedo,
        &IngestImages::albedoSpecular,
        &IngestImages::normal,
        &IngestImages::depth,
        &IngestImages::motion,
        &IngestImages::previousNormal,
        &IngestImages::reflectionMotion,
        &IngestImages::id,
        &IngestImages::roughness,
        &IngestImages::hitDistance,
        &IngestImages::radianceVariance,
        &IngestImages::specularVariance};
    if (input >= members.size()) throw UsageError(formatText("there is no input {}", input));
    return images.*members[input];
}

/// Throws UsageError if one of two lights has a variance and the other has none, or the number of samples is
/// missing.
void requireVariances(const limpid_denoiser_desc& desc, const IngestImages& images) {
    const bool radiance{images.radianceVariance}, specular{images.specularVariance};
    if (images.specular && radiance != specular)
        throw UsageError(formatText(
            "the input '{}' is missing",
            inputName(radiance ? LIMPID_INPUT_SPECULAR_VARIANCE : LIMPID_INPUT_RADIANCE_VARIANCE)));
    if (radiance && desc.samples < 2)
        throw UsageError(
            formatText("the input 'radiance_variance' needs limpid_denoiser_desc::samples of 2 or "
                       "more, not {}",
                       desc.samples));
}

void requireInputs(const limpid_denoiser_desc& desc, const IngestImages& images) {
    const auto require = [](gpu::ImageHandle image, limpid_input input) {
        if (!image) throw UsageError(formatText("the input '{}' is missing", inputName(input)));
    };
    require(images.radiance, LIMPID_INPUT_RADIANCE);
    require(images.normal, LIMPID_INPUT_NORMAL);
    require(images.depth, LIMPID_INPUT_DEPTH);
    if (desc.signals == 2) require(images.specular, LIMPID_INPUT_SPECULAR);
    if (images.hitDistance) require(images.roughness, LIMPID_INPUT_ROUGHNESS);
    requireVariances(desc, images);
}

std::vector<DryFrame> dryFrames() {
    const std::vector<limpid_input> optional{
        LIMPID_INPUT_EMISSION,        LIMPID_INPUT_ALBEDO, LIMPID_INPUT_ALBEDO_SPECULAR,  LIMPID_INPUT_MOTION,
        LIMPID_INPUT_PREVIOUS_NORMAL, LIMPID_INPUT_ID,     LIMPID_INPUT_REFLECTION_MOTION};
    std::vector<limpid_input> all = optional;
    // With two signals it is there nevertheless.
    all.insert(all.end(), {LIMPID_INPUT_SPECULAR, LIMPID_INPUT_ROUGHNESS, LIMPID_INPUT_HIT_DISTANCE});
    const std::vector<std::vector<limpid_input>> without{
        {},
        {LIMPID_INPUT_ALBEDO_SPECULAR, LIMPID_INPUT_SPECULAR, LIMPID_INPUT_REFLECTION_MOTION},
        {LIMPID_INPUT_EMISSION, LIMPID_INPUT_ROUGHNESS, LIMPID_INPUT_HIT_DISTANCE},
        optional,
        all};
    std::vector<DryFrame> frames{
        {.orthographic = true},
        {.without = {LIMPID_INPUT_ROUGHNESS, LIMPID_INPUT_HIT_DISTANCE}, .orthographic = true}};
    for (const gpu::Format color : {gpu::Format::RGBA16Float, gpu::Format::RGBA32Float})
        for (const auto& inputs : without) frames.push_back({.without = inputs, .color = color});
    return frames;
}

void recordDryFrame(gpu::FrameGraph& graph, const limpid_denoiser_desc& desc, const FilterSettings& settings,
                    const gpu::FilterChoice& choice, const DryFrame& frame, bool signalsToo) {
    const gpu::Extent extent{desc.width, desc.height};
    constexpr gpu::ForeignImage nowhere{.image = 1, .view = 1};
    graph.beginFrame();
    IngestImages images;
    for (size_t input = 0; input < inputCount; ++input) {
        if (desc.samples < 2 && input >= LIMPID_INPUT_RADIANCE_VARIANCE) continue;
        const bool needed = input == LIMPID_INPUT_SPECULAR && desc.signals == 2;
        if (!needed &&
            std::ranges::find(frame.without, static_cast<limpid_input>(input)) != frame.without.end())
            continue;
        const bool unsignedInput = input == LIMPID_INPUT_ID;
        imageOf(images, input) =
            graph.import(formatText("input/{}", inputName(input)),
                         unsignedInput ? gpu::Format::RGBA32Uint : gpu::Format::RGBA32Float, extent, nowhere);
    }
    limpid_camera camera{};
    for (auto* view : {&camera.view, &camera.previous_view}) std::ranges::copy(identity, *view);
    for (auto* projection : {&camera.projection, &camera.previous_projection})
        std::ranges::copy(frame.orthographic ? identity : perspective, *projection);
    const gpu::ImageHandle target = graph.import("output/color", frame.color, extent, nowhere);
    const InstanceOutputs outputs = recordFrame(graph, desc, settings, images,
                                                ingestParams(desc, camera, true), choice, signalsToo, target);
    if (outputs.color != target) output(graph, "color", outputs.color, target);
    if (outputs.radiance) {
        output(graph, "radiance", outputs.radiance,
               graph.import("output/radiance", frame.color, extent, nowhere));
    }
}

}  // namespace limpid::denoise

limpid_denoiser::limpid_denoiser(const limpid_device& on, const limpid_denoiser_desc& wanted)
    : device(on.device), adopted(on.adopted), desc(wanted), graph(graphOptions(wanted)) {
    desc.name = nullptr;  // a string of the caller's; the graph has its own copy
    for (const DryFrame& frame : dryFrames()) {
        gpu::FrameGraph dry;
        recordDryFrame(dry, desc, settings, gpu::filterChoice(*device), frame, true);
        dry.prepare(*device);
    }
}

bool limpid_denoiser::startsAnew(bool reset) {
    if (reset) {
        graph.resetHistories();
        hasPrevious = false;
    }
    return !hasPrevious || !readsHistory(desc, settings);
}

extern "C" {

uint32_t limpid_version(void) {
    return 10000 * LIMPID_VERSION_MAJOR + 100 * LIMPID_VERSION_MINOR + LIMPID_VERSION_PATCH;
}

const char* limpid_last_error(void) {
    return lastErrorText();
}

limpid_result limpid_device_create(const limpid_device_desc* desc, limpid_device** device) {
    return guarded([&] {
        required(device, "device") = nullptr;
        *device = new limpid_device{openDevice(desc), false};
    });
}

void limpid_device_destroy(limpid_device* device) {
    delete device;
}

const char* limpid_device_name(const limpid_device* device) {
    return device ? device->device->info().name.c_str() : "";
}

limpid_result limpid_device_pipeline_cache(const limpid_device* device, void* data, size_t* size) {
    return guarded([&] {
        const std::vector<std::byte> bytes = required(device, "device").device->pipelineCacheData();
        const size_t room = std::exchange(required(size, "size"), bytes.size());
        if (!data) return;
        if (room < bytes.size())
            throw UsageError(formatText("the pipeline cache has {} bytes, more than {}", bytes.size(), room));
        std::memcpy(data, bytes.data(), bytes.size());
    });
}

limpid_result limpid_device_load_pipeline_cache(limpid_device* device, const void* data, size_t size) {
    return guarded([&] {
        required(device, "device");
        if (size != 0) required(static_cast<const char*>(data), "data");
        device->device->loadPipelineCache({static_cast<const std::byte*>(data), size});
    });
}

limpid_result limpid_denoiser_create(limpid_device* device, const limpid_denoiser_desc* desc,
                                     limpid_denoiser** denoiser) {
    return guarded([&] {
        required(denoiser, "denoiser") = nullptr;
        const limpid_denoiser_desc d = wholeStruct(desc, "limpid_denoiser_desc");
        check(d);
        checkSize(*required(device, "device").device, d);
        *denoiser = new limpid_denoiser(*device, d);
    });
}

void limpid_denoiser_destroy(limpid_denoiser* denoiser) {
    delete denoiser;
}

limpid_result limpid_denoiser_memory(const limpid_denoiser_desc* desc, int32_t for_gpu, uint64_t* bytes) {
    return guarded([&] {
        const limpid_denoiser_desc d = wholeStruct(desc, "limpid_denoiser_desc");
        check(d);
        uint64_t& most = required(bytes, "bytes") = 0;
        for (const DryFrame& frame : {DryFrame{}, DryFrame{.without = {LIMPID_INPUT_REFLECTION_MOTION}}}) {
            gpu::FrameGraph dry(graphOptions(d));
            recordDryFrame(dry, d, {}, {.backing = for_gpu ? gpu::Backing::Buffer : gpu::Backing::Image},
                           frame, false);
            most = std::max(most, dry.imageBytes());
        }
    });
}

limpid_result limpid_denoiser_resize(limpid_denoiser* denoiser, uint32_t width, uint32_t height) {
    return guarded([&] {
        limpid_denoiser_desc d = required(denoiser, "denoiser").desc;
        d.width = width;
        d.height = height;
        check(d);
        checkSize(*denoiser->device, d);
        denoiser->desc = d;
        denoiser->startsAnew(true);
    });
}

limpid_result limpid_denoiser_reset(limpid_denoiser* denoiser) {
    return guarded([&] { required(denoiser, "denoiser").startsAnew(true); });
}

limpid_result limpid_method_parameter(limpid_method method, uint32_t index, limpid_parameter* parameter) {
    return guarded([&] {
        const std::vector<InstanceParameter>& all = parametersOf(method);
        if (index >= all.size()) throw UsageError(formatText("the method has {} parameters", all.size()));
        required(parameter, "parameter") = describe(all[index]);
    });
}

limpid_result limpid_denoiser_set(limpid_denoiser* denoiser, const char* name, double value) {
    return guarded([&] {
        required(denoiser, "denoiser");
        setParameter(denoiser->settings, denoiser->desc.method, &required(name, "name"), value);
    });
}

limpid_result limpid_denoiser_get(const limpid_denoiser* denoiser, const char* name, double* value) {
    return guarded([&] {
        required(denoiser, "denoiser");
        required(value, "value") =
            parameter(denoiser->settings, denoiser->desc.method, &required(name, "name"));
    });
}

limpid_result limpid_denoiser_timings(limpid_denoiser* denoiser, limpid_timing* timings, uint32_t* count) {
    return guarded([&] {
        limpid_denoiser& d = required(denoiser, "denoiser");
        uint32_t& n = required(count, "count");
        std::vector<gpu::PassTime> latest = d.graph.passTimes(*d.device);
        if (!latest.empty()) d.times = std::move(latest);
        const auto all = static_cast<uint32_t>(d.times.size());
        n = timings ? std::min(n, all) : all;
        for (uint32_t i = 0; timings && i < n; ++i)
            timings[i] = {d.times[i].name.c_str(), d.times[i].milliseconds};
    });
}

}  // extern "C"
