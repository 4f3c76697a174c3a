// The signals that SVGF filters, and where a frame keeps their light.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {

struct Signal {
    std::string name;
    SvgfSignal signal;
};

inline std::vector<Signal> signalsOf(const denoise::SvgfSettings& settings) {
    if (!settings.separate) return {{"joint", SvgfSignal::Joint}};
    return {{"diffuse", SvgfSignal::Diffuse}, {"specular", SvgfSignal::Specular}};
}

/// The accumulated light, with its deviation in space where the history is short.
inline gpu::ImageHandle withVariance(const gpu::FrameGraph& graph, const std::string& signal) {
    for (const gpu::ImageHandle image : graph.imagesWrittenBy("svgf/variance " + signal)) {
        const std::string name = graph.name(image);
        if (name.ends_with(" color") || name.ends_with(" accumulated")) return image;
    }
    throw Error("svgf/variance writes no light");
}

}  // namespace limpid::test
