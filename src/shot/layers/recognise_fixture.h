// What the tests of recognise() share.
#pragma once

#include <gmock/gmock.h>

#include <string>
#include <string_view>
#include <vector>

#include "shot/layers/recognise.h"
#include "shot/layers/shot_fixture.h"

namespace limpid::shot::test {

class RecogniseTest : public testing::Test {
  protected:
    /// Each channel's value is its length, so that sums and products can be told apart.
    image::ExrDocument file(const std::vector<TestPart>& parts) {
        const auto value = [](const std::string& channel, uint32_t, uint32_t) {
            return static_cast<float>(channel.size());
        };
        return image::ExrDocument::read(test::writeParts(folder_ / "a.exr", parts, 4, 2, value));
    }

    static std::string textOf(const LayerMap& map, std::string_view role) {
        const LayerExpression* const layer = map.find(role);
        return layer ? layer->text() : "";
    }

    image::test::TempFolder folder_;
};

inline std::vector<std::string> allOf(std::vector<std::vector<std::string>> lists) {
    std::vector<std::string> result;
    for (auto& list : lists) result.insert(result.end(), list.begin(), list.end());
    return result;
}

inline std::vector<std::string> cyclesChannels(const std::string& view) {
    const auto colors = [&](const std::string& pass) { return names("A B G R", view + pass + "."); };
    return allOf({colors("Combined"),
                  colors("DiffDir"),
                  colors("DiffInd"),
                  colors("DiffCol"),
                  colors("GlossDir"),
                  colors("GlossInd"),
                  colors("GlossCol"),
                  colors("Emit"),
                  colors("Env"),
                  names("X Y Z", view + "Normal."),
                  names("W X Y Z", view + "Vector."),
                  names("Depth.Z IndexOB.X", view),
                  names("B G R", view + "Denoising Albedo."),
                  names("X Y Z", view + "Denoising Normal."),
                  {view + "Denoising Depth.Z"}});
}

}  // namespace limpid::shot::test
