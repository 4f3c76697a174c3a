// A whole studio on the test device.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "gpu/specialise/specialise.h"
#include "studio/state/state_json.h"
#include "studio/studio.h"

namespace limpid::studio {

class StudioTest : public testing::Test {
  protected:
    void SetUp() override {
        if (gpu::enumerateDevices().empty()) GTEST_SKIP() << "NOT TESTED: this machine has no Vulkan device.";
    }

    static std::string wantedDevice() {
        const char* const variable = std::getenv("LIMPID_TEST_DEVICE");
        return variable ? variable : "cpu";
    }
    static std::unique_ptr<Studio> make(StudioSettings settings, SceneLoader load = scene::openScene) {
        settings.maxSamples = std::min<uint64_t>(settings.maxSamples, 2);
        return std::make_unique<Studio>(
            gpu::DeviceOptions{.select = wantedDevice(), .specialise = gpu::specialiser()},
            [](const gpu::Device&) { return scene::Tracer::Compute; }, std::move(load),
            [](const scene::Scene& scene) { return scene.cameras.front(); }, settings);
    }
    static StudioSettings small(const char* scene = "builtin:cornell") {
        StudioSettings settings;
        settings.source.scene = scene;
        settings.render.extent = {64, 48};
        return settings;
    }
    /// The first snapshot that fits, which also includes a message.
    template <typename Fits>
    static std::shared_ptr<const Shown> wait(const Studio& studio, uint64_t message, const Fits& fits) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        while (std::chrono::steady_clock::now() < end && !studio.hasEnded()) {
            auto shown = studio.shown();
            if (shown->messages >= message && fits(*shown)) return shown;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        ADD_FAILURE() << "waited in vain: " << toJson(studio.shown()->facts).dump();
        return studio.shown();
    }
    static std::shared_ptr<const Shown> rest(const Studio& studio, uint64_t message = 0) {
        return wait(studio, message, [](const Shown& s) {
            return s.picture && !s.facts.computing && s.picture->extent == s.state.viewport;
        });
    }
};

}  // namespace limpid::studio
