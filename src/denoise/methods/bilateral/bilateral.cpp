#include "denoise/methods/bilateral/bilateral.h"

#include <algorithm>

#include "bilateral.comp.h"
#include "denoise/methods/bilateral/bilateral_params.h"
#include "denoise/methods/methods.h"

namespace limpid::denoise {

gpu::ImageHandle filterBilateral(gpu::FrameGraph& graph, const DenoiserInput& input,
                                 const BilateralSettings& settings) {
    const gpu::Extent extent = graph.extent(input.diffuse);
    const gpu::ImageHandle beauty = graph.transient("bilateral", gpu::Format::RGBA32Float, extent);
    const float sigma = std::max(0.5f * static_cast<float>(settings.radius), 0.5f);
    const BilateralParams params{.camera = input.camera,
                                 .width = extent.width,
                                 .height = extent.height,
                                 .radius = settings.radius,
                                 .spatial = 0.5f / (sigma * sigma),
                                 .normalPower = settings.normalPower,
                                 .minAlbedo = settings.minAlbedo,
                                 .plane = settings.plane};
    graph.dispatch(
        {.pass = "bilateral",
         .shader = shaders::bilateral_comp,
         .bindings = {{"diffuse", input.diffuse},
                      {"specular", input.specular ? input.specular : input.diffuse},
                      {"albedo", input.albedo},
                      {"emission", input.emission ? input.emission : input.diffuse},
                      {"normal", input.normal},
                      {"depth", input.depth},
                      {"beauty", beauty}},
         .params = gpu::paramsOf(params),
         .constants = {{"TWO_LIGHTS", input.specular ? 1u : 0u}, {"EMISSION", input.emission ? 1u : 0u}},
         .extent = extent});
    return beauty;
}

const ParamTable<BilateralSettings>& bilateral::params() {
    static const auto table = [] {
        using S = BilateralSettings;
        ParamTable<S> t("bilateral");
        t.add("radius", &S::radius, 0, 16, "pixels",
              "Pixels that the filter reaches; higher is smoother and slower, by the square");
        t.add("normal_power", &S::normalPower, 0.0, 1024.0, "",
              "Exponent of the cosine between normals; higher keeps edges, lower smooths across them");
        t.add("min_albedo", &S::minAlbedo, 1e-3, 1.0, "",
              "Minimum albedo that light is divided by; lower keeps the colours of dark surfaces apart, "
              "higher limits their noise")
            .slider(1e-3, 1, SliderScale::Logarithmic);
        t.add("plane", &S::plane, 1e-6, 1e6, "of the distance",
              "Tolerated distance from the pixel's plane; lower keeps steps, higher smooths across them")
            .slider(1e-4, 1, SliderScale::Logarithmic);
        return t;
    }();
    return table;
}

DenoiserOutput bilateral::record(gpu::FrameGraph& graph, const DenoiserInput& input,
                                 const FilterSettings& settings) {
    return {antialias(graph, input, filterBilateral(graph, input, settings.bilateral), settings.taa), {}};
}

}  // namespace limpid::denoise
