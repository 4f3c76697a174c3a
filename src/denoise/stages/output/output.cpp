#include "denoise/stages/output/output.h"

#include "output_float.comp.h"
#include "output_half.comp.h"

namespace limpid::denoise {

void output(gpu::FrameGraph& graph, const char* name, gpu::ImageHandle picture, gpu::ImageHandle result) {
    const gpu::Extent extent = graph.extent(picture);
    const bool half = graph.format(result) == gpu::Format::RGBA16Float;
    graph.dispatch({.pass = std::string("output/") + name,
                    .shader = half ? shaders::output_half_comp : shaders::output_float_comp,
                    .bindings = {{"picture", picture}, {"result", result}},
                    .params = gpu::paramsOf(extent),
                    .constants = {},
                    .extent = extent});
}

}  // namespace limpid::denoise
