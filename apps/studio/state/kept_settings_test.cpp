#include "studio/state/kept_settings.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "renderer/method/parameters.h"

namespace limpid::studio {
namespace {

class KeptSettingsTest : public testing::Test {
  protected:
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("limpid_kept_test." + std::to_string(::getpid()));
    std::filesystem::path file_ = folder_ / "deeper" / "view.json";
};

TEST_F(KeptSettingsTest, WhatIsKeptComesBack) {
    StudioSettings settings;
    settings.render.pipeline = parsePipeline("ao", "svgf");
    settings.samples = 3;
    settings.maxSamples = 77;
    settings.resolution = Resolution::Quarter;
    assign(settings.render, "svgf.levels=2");
    assign(settings.render, "atrous.levels=3");
    keepSettings(file_, settings);
    StudioSettings restored;
    restoreSettings(file_, restored);
    EXPECT_EQ(restored.render, settings.render);
    EXPECT_EQ(restored.samples, 3u);
    EXPECT_EQ(restored.maxSamples, 77u);
    EXPECT_EQ(restored.resolution, Resolution::Quarter);
}

TEST_F(KeptSettingsTest, WhatIsNotThereOrDamagedIsNothing) {
    StudioSettings restored;
    restoreSettings(file_, restored);
    restoreSettings({}, restored);
    keepSettings(file_, restored);
    for (
        const char* text :
        {"", "{", "{}", "[1]", R"({"integrator": "none", "denoiser": "none"})",
         R"({"integrator": "gbuffer", "denoiser": "svgf"})",
         R"({"integrator": "path", "denoiser": "none", "samples": -1, "max_samples": 1, "shrink": 0, "parameters": []})",
         R"({"integrator": "path", "denoiser": "none", "samples": 1, "max_samples": 1, "shrink": 0, "parameters": ["x.y=1"]})"}) {
        std::ofstream(file_) << text;
        EXPECT_NO_THROW(restoreSettings(file_, restored)) << text;
        EXPECT_EQ(restored.render, RenderSettings{}) << text;
        EXPECT_GE(restored.samples, 1u) << text;
        EXPECT_LE(restored.samples, 64u) << text;
    }
}

}  // namespace
}  // namespace limpid::studio
