// Runs denoisers on frames from host memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "denoise/api/denoiser.h"
#include "tests/gpu/gpu_fixture.h"
#include "tests/oracle/double_atrous.h"
#include "tests/oracle/double_temporal.h"
#include "tests/oracle/synthetic/synthetic_frames.h"

namespace limpid::test {

using denoise::DenoiserSettings;
using denoise::HostFrame;

inline std::vector<dvec4> asDouble(const std::vector<float>& texels) {
    std::vector<dvec4> result(texels.size() / 4);
    for (size_t p = 0; p < result.size(); ++p)
        result[p] = {texels[4 * p], texels[4 * p + 1], texels[4 * p + 2], texels[4 * p + 3]};
    return result;
}

/// Of all channels but alpha, of RGBA texels.
inline float medianOf(const std::vector<float>& picture) {
    std::vector<float> values;
    for (size_t i = 0; i < picture.size(); ++i) {
        if (i % 4 != 3) values.push_back(picture[i]);
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// Turns a frame into one of several samples with deviations from none to about the light's luminance.
inline void addVariances(HostFrame& frame, uint32_t samples) {
    frame.samples = samples;
    frame.variances = samples > 1;
    for (auto* layer : {&frame.diffuse, &frame.specular}) {
        for (size_t i = 0; i < frame.pixelCount() * 4; i += 4) {
            const float deviation = (*layer)[i] * static_cast<float>(i * 7919 % 17) / 16.0f;
            (*layer)[i + 3] = deviation * deviation;
        }
    }
}

class DenoiseTest : public GpuTest {
  protected:
    /// Returns the image that a pass of the last frame wrote, found by the end of its name.
    gpu::ImageHandle written(const std::string& pass, const std::string& nameEnd) const {
        for (const gpu::ImageHandle image : graph_.imagesWrittenBy(pass)) {
            if (graph_.name(image).ends_with(nameEnd)) return image;
        }
        throw Error("pass '" + pass + "' writes no image '" + nameEnd + "'");
    }
    std::vector<dvec4> download(gpu::ImageHandle image) {
        return asDouble(graph_.downloadFloat(device(), image));
    }
    std::vector<dvec4> download(const std::string& pass, const std::string& nameEnd) {
        return download(written(pass, nameEnd));
    }

    /// Four floats per pixel, as an image of the frame that is being recorded.
    gpu::ImageHandle uploaded(const char* name, const std::vector<float>& pixels, gpu::Extent extent) {
        const gpu::ImageHandle image = graph_.transient(name, gpu::Format::RGBA32Float, extent);
        graph_.upload(image, gpu::bytesOf(pixels));
        return image;
    }

    /// Runs one frame of a method; the next call is the next frame. Returns the beauty, four floats per
    /// pixel.
    std::vector<float> denoise(const denoise::Denoiser& method, const HostFrame& frame,
                               const DenoiserSettings& settings = {}) {
        graph_.beginFrame();
        denoise::DenoiserInput input = denoise::upload(graph_, frame);
        input.filters = filters_;
        input.matrices = matrices_;
        input.cpu = cpu_ && device().isCpu();
        input.largestBuffer = largestBuffer_;
        output_ = method.record(graph_, input, settings, networks_);
        graph_.execute(device());
        return graph_.downloadFloat(device(), output_.beauty);
    }

    gpu::FrameGraph graph_;
    denoise::DenoiserOutput output_;
    denoise::DenoiserNetworks networks_;
    gpu::Backing filters_ = gpu::Backing::Image;
    bool matrices_ = false;  ///< cooperative matrices, on devices that have them
    bool cpu_ = true;        ///< oneDNN computes networks on devices that are the CPU, as in the program
    uint64_t largestBuffer_ = UINT64_MAX;
};

}  // namespace limpid::test
