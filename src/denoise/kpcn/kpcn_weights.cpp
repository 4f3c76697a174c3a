#include "denoise/kpcn/kpcn_weights.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_float.h"
#include "base/text/format.h"
#include "denoise/kpcn/kpcn_params.h"
#include "neural/tensor_file.h"

namespace limpid::denoise {
namespace {

using nlohmann::json;

constexpr uint32_t maxHidden = 64, maxChannels = 1024, widestKernel = 31;
constexpr float largestHalf = 65504.0f;
constexpr float minFacing = -2.0f;
/// Equal normals must pass: rounded to 8 bits, their product with themselves may be as small as 0.986.
constexpr float maxFacing = 0.98f;

struct Shape {
    uint32_t hidden, channels, width;
    float facing;
    bool logarithmicDiffuse;
};

std::string textOf(const std::vector<uint64_t>& shape) {
    std::vector<std::string> lengths;
    for (const uint64_t length : shape) lengths.push_back(std::to_string(length));
    return joinText(lengths);
}

class Reader {
  public:
    explicit Reader(const std::filesystem::path& path) : path_(path), file_(neural::readTensorFile(path)) {}

    /// The file is read already.
    KpcnWeights read(const Progress& progress) {
        const size_t tensors = file_.tensors.size();
        const Shape shape = readShape();
        KpcnWeights result;
        result.kernelWidth = shape.width;
        result.facing = shape.facing;
        result.logarithmicDiffuse = shape.logarithmicDiffuse;
        const char* names[] = {"diffuse", "specular"};
        for (size_t side = 0; side < 2; ++side) {
            uint32_t inputs = KPCN_INPUT_CHANNELS;
            for (uint32_t i = 0; i < shape.hidden; ++i) {
                progress.at(tensors - file_.tensors.size(), tensors);
                result.sides[side].push_back(
                    layer(formatText("{}.hidden.{}", names[side], i), inputs, shape.channels));
                inputs = shape.channels;
            }
            result.sides[side].push_back(
                layer(formatText("{}.output", names[side]), inputs, shape.width * shape.width));
        }
        if (!file_.tensors.empty())
            fail(formatText("holds a tensor '{}', which its shape has no place for",
                            file_.tensors.begin()->first));
        return result;
    }

  private:
    [[noreturn]] void fail(const std::string& fault) const { throw InputError(path_, fault); }

    Shape readShape() const {
        const auto kind = file_.metadata.find("limpid.network"), text = file_.metadata.find("limpid.shape");
        if (kind == file_.metadata.end() || kind->second != "kpcn" || text == file_.metadata.end())
            fail("holds no KPCN weights (training/limpid_training/export.py writes such files)");
        const json shape = json::parse(text->second, nullptr, false);
        const auto number = [&](const char* name, uint32_t max) {
            if (!shape.is_object() || !shape.contains(name) || !shape[name].is_number_unsigned() ||
                shape[name].get<uint64_t>() < 1 || shape[name].get<uint64_t>() > max)
                fail(formatText("its metadata limpid.shape has no '{}' from 1 to {}", name, max));
            return shape[name].get<uint32_t>();
        };
        const Shape result{number("hidden", maxHidden), number("channels", maxChannels),
                           number("width", widestKernel), readFacing(shape), readDiffuseInput(shape)};
        if (result.width % 2 == 0) fail("its kernels have no centre: limpid.shape has an even 'width'");
        return result;
    }

    /// Older files do not have the field; their networks use the default.
    float readFacing(const json& shape) const {
        if (!shape.contains("facing")) return KpcnWeights{}.facing;
        const auto facing = finiteFloat(shape["facing"]);
        if (!facing || !(*facing >= minFacing && *facing <= maxFacing))
            fail(formatText("its metadata limpid.shape has no 'facing' from {} to {}", minFacing, maxFacing));
        return *facing;
    }

    /// Older files do not have this field either: their networks see logarithms.
    bool readDiffuseInput(const json& shape) const {
        const json input = shape.value("diffuse_input", json("logarithmic"));
        if (input != "logarithmic" && input != "linear")
            fail("its metadata limpid.shape has a 'diffuse_input' other than \"logarithmic\" and \"linear\"");
        return input == "logarithmic";
    }

    /// Returns a tensor's values and removes it from `file_`, so that read() can detect tensors that are left
    /// over.
    std::vector<float> take(const std::string& name, const std::vector<uint64_t>& shape) {
        const auto found = file_.tensors.find(name);
        if (found == file_.tensors.end()) fail(formatText("lacks the tensor '{}'", name));
        if (found->second.shape != shape)
            fail(formatText("the tensor '{}' has the shape ({}), not ({})", name, textOf(found->second.shape),
                            textOf(shape)));
        const std::vector<float> values = neural::valuesOf(found->second);
        if (!std::ranges::all_of(values, [](float v) { return std::abs(v) <= largestHalf; }))
            fail(formatText("the tensor '{}' holds numbers that are not finite or beyond half precision",
                            name));
        file_.tensors.erase(found);
        return values;
    }

    KpcnLayer layer(const std::string& name, uint32_t inputs, uint32_t outputs) {
        return {inputs, outputs, take(name + ".weight", {outputs, inputs, KPCN_TAPS, KPCN_TAPS}),
                take(name + ".bias", {outputs})};
    }

    const std::filesystem::path& path_;
    neural::TensorFile file_;
};

}  // namespace

KpcnWeights readKpcnWeights(const std::filesystem::path& path, const Progress& progress) {
    progress.at(0.0);
    return Reader(path).read(progress.part(0.5, 1.0));
}

}  // namespace limpid::denoise
