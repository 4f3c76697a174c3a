#include "denoise/methods/nano/nano_matrices.h"

#include "base/divide_up.h"
#include "base/error.h"
#include "nano_around_matrix.comp.h"
#include "nano_around_matrix_small.comp.h"
#include "nano_within_matrix.comp.h"
#include "nano_within_matrix_small.comp.h"

namespace limpid::denoise {
namespace {

constexpr uint32_t subgroupSize = 32;  // see DeviceInfo::cooperativeMatrices

gpu::Extent threadsOf(const NanoConvolveParams& params, const NanoShare& share) {
    if (share.tiles == 0 || params.outputGroups % (2 * share.tiles) != 0 || params.groups % 2 != 0)
        throw Error("a layer has no shape for matrices");
    const uint32_t subgroups = share.small ? NANO_SMALL_SUBGROUPS : NANO_SUBGROUPS;
    const uint32_t blocks = divideUp(params.height, subgroups * share.rows * share.loops);
    return {divideUp(params.width, NANO_COLUMNS) * subgroups * subgroupSize,
            blocks * (params.outputGroups / 2 / share.tiles)};
}

void around(gpu::FrameGraph& graph, const NanoConvolution& c) {
    const NanoShare& share = c.share;
    graph.dispatch(
        {.pass = c.pass,
         .shader = share.small ? shaders::nano_around_matrix_small_comp : shaders::nano_around_matrix_comp,
         .bindings = {{"inputs", c.inputs}, {"weights", c.weights}, {"outputs", c.outputs}},
         .params = gpu::paramsOf(c.params),
         .constants = {{"TILES", share.tiles},
                       {"ROWS", share.rows},
                       {"LOOPS", share.loops},
                       {"SLABS", c.params.groups / 2}},
         .extent = threadsOf(c.params, share)});
}

void within(gpu::FrameGraph& graph, const NanoConvolution& c) {
    const bool halves = c.taps == NANO_HALVE;
    const NanoShare& share = c.share;
    const uint32_t groups = halves ? 4 * c.params.groups : c.params.groups + c.params.coarserGroups;
    graph.dispatch(
        {.pass = c.pass,
         .shader = share.small ? shaders::nano_within_matrix_small_comp : shaders::nano_within_matrix_comp,
         .bindings =
             {{"inputs", c.inputs}, {"coarser", c.coarser}, {"weights", c.weights}, {"outputs", c.outputs}},
         .params = gpu::paramsOf(c.params),
         .constants = {{"TILES", share.tiles},
                       {"ROWS", share.rows},
                       {"LOOPS", share.loops},
                       {"SLABS", groups / 2},
                       {"OWN_SLABS", c.params.groups / 2},
                       {"HALVES", halves ? 1u : 0u}},
         .extent = threadsOf(c.params, share)});
}

}  // namespace

void convolveByMatrices(gpu::FrameGraph& graph, const NanoConvolution& convolution) {
    if (convolution.taps == NANO_AROUND) return around(graph, convolution);
    within(graph, convolution);
}

}  // namespace limpid::denoise
