#include "image/colormap.h"

#include <algorithm>

#include "base/error.h"
#include "image/io/png/png.h"

namespace limpid::image {

std::array<float, 3> magma(float value) {
    constexpr std::array<std::array<float, 3>, 7> c = {{
        {-0.002136485053939582f, -0.000749655052795221f, -0.005386127855323933f},
        {0.2516605407371642f, 0.6775232436837668f, 2.494026599312351f},
        {8.353717279216625f, -3.577719514958484f, 0.3144679030132573f},
        {-27.66873308576866f, 14.26473078096533f, -13.64921318813922f},
        {52.17613981234068f, -27.94360607168351f, 12.94416944238394f},
        {-50.76852536473588f, 29.04658282127291f, 4.23415299384598f},
        {18.65570506591883f, -11.48977351997711f, -5.601961508734096f},
    }};
    const float t = value <= 1.0f ? std::max(value, 0.0f) : 1.0f;
    std::array<float, 3> color{};
    for (size_t k = 0; k < 3; ++k) {
        float sum = 0.0f;
        for (size_t power = c.size(); power-- > 0;) sum = sum * t + c[power][k];
        color[k] = std::clamp(sum, 0.0f, 1.0f);
    }
    return color;
}

Image magma(const Image& values) {
    if (values.components != 1) throw Error("a colour map needs an image of one component");
    Image colors(values.width, values.height, 3);
    for (size_t i = 0; i < values.pixels.size(); ++i) {
        const std::array<float, 3> color = magma(values.pixels[i]);
        std::copy(color.begin(), color.end(), colors.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return colors;
}

void writeErrorMap(const std::filesystem::path& path, const Image& errors) {
    writePng(path, toBytes(magma(errors)));
}

}  // namespace limpid::image
