#include "denoise/api/network/network_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/text/format.h"
#include "denoise/api/host_pixels.h"

namespace limpid::denoise {
namespace {

constexpr uint32_t defaultSamples = 32;  ///< of the frames that the shipped networks learnt from
constexpr uint32_t maxSide = 32768;

constexpr std::array<const char*, 11> inputNames{
    "diffuse",          "specular",          "emission",        "albedo",          "normal",        "depth",
    "diffuse_variance", "specular_variance", "albedo_variance", "normal_variance", "depth_variance"};

class Reader {
  public:
    Reader(const limpid_network_frame& frame, const MessageCallback& messages)
        : frame_(frame), messages_(messages) {
        const auto possible = [](uint32_t side) { return side >= 1 && side <= maxSide; };
        if (!possible(frame.width) || !possible(frame.height))
            throw UsageError(formatText("images of {} x {} pixels: each side has 1 to {}", frame.width,
                                        frame.height, maxSide));
        for (size_t input = inputNames.size(); input < LIMPID_NETWORK_INPUT_MAX; ++input) {
            if (frame.inputs[input].data) throw UsageError(formatText("there is no input {}", input));
        }
        samples_ = std::max(frame.samples == 0 ? defaultSamples : frame.samples, 2u);
    }

    uint32_t samples() const { return samples_; }
    bool has(limpid_network_input input) const { return frame_.inputs[input].data != nullptr; }

    /// The fourth of four floats is 0. `absent`: the others of an image that the caller does not have.
    std::vector<float> color(limpid_network_input input, float absent = 0.0f) const {
        if (!has(input)) return filled(absent);
        std::vector<float> texels = read(input, 3);
        size_t bad = 0;
        for (size_t i = 0; i < texels.size(); i += 4) {
            bad += std::isfinite(texels[i] + texels[i + 1] + texels[i + 2]) ? 0 : 1;
            texels[i + 3] = 0.0f;
        }
        warn(input, bad);
        return texels;
    }

    /// With variance, which must be there if `required`.
    std::vector<float> colorAndVariance(limpid_network_input input, limpid_network_input variance,
                                        bool required, float absent = 0.0f) const {
        std::vector<float> texels = color(input, absent);
        if (has(input)) addVariance(texels, variance, required);
        return texels;
    }

    /// And variance.
    std::vector<float> light(limpid_network_input input, limpid_network_input variance) const {
        std::vector<float> texels = colorAndVariance(input, variance, true);
        bool any = false;
        for (size_t i = 0; !any && i < texels.size(); i += 4)
            any = std::isfinite(texels[i] + texels[i + 1] + texels[i + 2]);
        if (!any) throw UsageError(formatText("the image '{}' has no finite pixel", inputNames[input]));
        return texels;
    }

    /// Distance, whether something is seen, 0, variance.
    std::vector<float> depth(float farDepth) const {
        std::vector<float> texels = read(LIMPID_NETWORK_INPUT_DEPTH, 1);
        for (size_t i = 0; i < texels.size(); i += 4) {
            const bool seen = texels[i] > 0.0f && texels[i] < farDepth;
            texels[i] = seen ? texels[i] : 0.0f;
            texels[i + 1] = seen ? 1.0f : 0.0f;
            texels[i + 2] = texels[i + 3] = 0.0f;
        }
        addVariance(texels, LIMPID_NETWORK_INPUT_DEPTH_VARIANCE, false);
        return texels;
    }

    void require(limpid_network_input input) const {
        if (!has(input)) throw UsageError(formatText("the input '{}' is missing", inputNames[input]));
    }

  private:
    std::vector<float> filled(float value) const {
        std::vector<float> texels(size_t{4} * frame_.width * frame_.height, value);
        for (size_t i = 3; i < texels.size(); i += 4) texels[i] = 0.0f;
        return texels;
    }

    std::vector<float> read(limpid_network_input input, uint32_t fewest) const {
        return readPixels(frame_.inputs[input], frame_.width, frame_.height, inputNames[input], fewest);
    }

    /// As the mean squared deviation of the samples (DenoiserInput::samples).
    void addVariance(std::vector<float>& texels, limpid_network_input input, bool required) const {
        if (required) require(input);
        if (!has(input)) return;
        const std::vector<float> variances = read(input, 1);
        const auto ofDeviations = static_cast<float>(samples_ - 1);
        size_t bad = 0;
        for (size_t i = 0; i < texels.size(); i += 4) {
            bad += std::isfinite(variances[i]) ? 0 : 1;
            texels[i + 3] = variances[i] * ofDeviations;
        }
        warn(input, bad);
    }

    void warn(limpid_network_input input, size_t bad) const {
        if (bad == 0 || !messages_) return;
        messages_(MessageLevel::Warning,
                  formatText("'{}': {} pixels are NaN or infinite and count as 0", inputNames[input], bad));
    }

    const limpid_network_frame& frame_;
    const MessageCallback& messages_;
    uint32_t samples_ = 0;
};

}  // namespace

NetworkPixels readNetworkFrame(const limpid_network_frame& frame, float farDepth,
                               const MessageCallback& messages) {
    const Reader reader(frame, messages);
    if (!reader.has(LIMPID_NETWORK_INPUT_DIFFUSE) && !reader.has(LIMPID_NETWORK_INPUT_SPECULAR))
        throw UsageError("the inputs 'diffuse' and 'specular' are both missing: one of them is needed");
    reader.require(LIMPID_NETWORK_INPUT_NORMAL);
    reader.require(LIMPID_NETWORK_INPUT_DEPTH);
    NetworkPixels pixels;
    pixels.width = frame.width;
    pixels.height = frame.height;
    pixels.samples = reader.samples();
    pixels.diffuse = reader.light(LIMPID_NETWORK_INPUT_DIFFUSE, LIMPID_NETWORK_INPUT_DIFFUSE_VARIANCE);
    pixels.specular = reader.light(LIMPID_NETWORK_INPUT_SPECULAR, LIMPID_NETWORK_INPUT_SPECULAR_VARIANCE);
    pixels.emission = reader.color(LIMPID_NETWORK_INPUT_EMISSION);
    pixels.albedo = reader.colorAndVariance(LIMPID_NETWORK_INPUT_ALBEDO, LIMPID_NETWORK_INPUT_ALBEDO_VARIANCE,
                                            false, 1.0f);
    pixels.normal =
        reader.colorAndVariance(LIMPID_NETWORK_INPUT_NORMAL, LIMPID_NETWORK_INPUT_NORMAL_VARIANCE, false);
    pixels.depth = reader.depth(farDepth);
    return pixels;
}

DenoiserInput uploadNetworkFrame(gpu::FrameGraph& graph, const NetworkPixels& pixels) {
    const auto upload = [&](const char* name, const std::vector<float>& texels) {
        const gpu::ImageHandle image = graph.transient(std::string("input/") + name, gpu::Format::RGBA32Float,
                                                       {pixels.width, pixels.height});
        graph.upload(image, gpu::bytesOf(texels));
        return image;
    };
    DenoiserInput input;
    input.diffuse = upload("diffuse", pixels.diffuse);
    input.specular = upload("specular", pixels.specular);
    input.emission = upload("emission", pixels.emission);
    input.albedo = upload("albedo", pixels.albedo);
    input.normal = upload("normal", pixels.normal);
    input.depth = upload("depth", pixels.depth);
    input.samples = pixels.samples;
    return input;
}

}  // namespace limpid::denoise
