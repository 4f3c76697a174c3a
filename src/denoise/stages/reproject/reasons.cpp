#include "denoise/stages/reproject/reasons.h"

#include "reasons.comp.h"
#include "reasons_buffers.comp.h"

namespace limpid::denoise {

SignalReasons recordReasons(gpu::FrameGraph& graph, const DenoiserInput& input, const gpu::History& surfaces,
                            const ReasonsQuestion& question) {
    const gpu::Extent extent = graph.extent(question.frames.current);
    const std::string name = question.method + "/" + question.signal;
    const gpu::ImageHandle reasons = graph.transient(name + " reasons", gpu::Format::RG32Uint, extent);
    const gpu::ImageHandle shown = graph.transient(name + " history", gpu::Format::RGBA8Unorm, extent);
    ReasonsParams params{};
    params.camera = input.camera;
    params.width = extent.width;
    params.height = extent.height;
    params.tests = question.tests;
    params.lobeScale = question.lobeScale;
    params.longest = question.longest;
    params.shortens = question.shortens;
    params.cut = input.reasons.cut || !question.frames.valid || !surfaces.valid;
    const bool buffers = input.filters == gpu::Backing::Buffer;
    graph.dispatch(
        {.pass = question.method + "/reasons " + question.signal,
         .shader = buffers ? shaders::reasons_buffers_comp : shaders::reasons_comp,
         .bindings = {{"motion", input.motion},
                      {"previousNormal", input.previousNormal ? input.previousNormal : input.motion},
                      {"reflectionMotion",
                       question.reflectionMotion ? question.reflectionMotion : input.motion},
                      {"surfaces", surfaces.current},
                      {"surfacesBefore", surfaces.previous},
                      {"framesBefore", question.frames.previous},
                      {"framesNow", question.frames.current},
                      {"reasons", reasons},
                      {"shown", shown}},
         .params = gpu::paramsOf(params),
         .constants = {{"REFLECTIONS", question.reflectionMotion ? 1u : 0u},
                       {"LOBES", question.lobeScale > 0.0f ? 1u : 0u},
                       {"INSTANCES", question.instances ? 1u : 0u},
                       {"TURNS", input.previousNormal ? 1u : 0u}},
         .extent = extent});
    return {question.signal, reasons};
}

}  // namespace limpid::denoise
