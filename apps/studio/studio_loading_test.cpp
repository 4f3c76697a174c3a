// Scenes and networks that are loaded while others are shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <thread>

#include "base/error.h"
#include "base/log.h"
#include "base/progress.h"
#include "renderer/method/network_file.h"
#include "studio/state/state_json.h"
#include "studio/studio_fixture.h"

namespace limpid::studio {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using Kind = Request::Kind;

/// The old scene is shown until the new one is there; one that fails changes nothing.
TEST_F(StudioTest, ScenesLoadBesideTheRendering) {
    std::atomic<bool> go = false;
    const auto slow = [&](const scene::SceneSource& source, const Progress& progress) {
        if (source.scene == "builtin:lab-mirror") {
            while (!go) {
                progress.at(0.0);
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        }
        return scene::openScene(source, progress);
    };
    const auto studio = make(small(), slow);
    const auto first = rest(*studio);
    wait(*studio, studio->ask({.kind = Kind::Open, .file = "builtin:lab-mirror"}),
         [](const Shown& s) { return s.facts.activity == "loading builtin:lab-mirror"; });
    const auto still = rest(*studio, studio->edit({{"seed", 3}}));
    EXPECT_EQ(still->facts.scene, first->facts.scene);
    EXPECT_NE(still->picture->texels, first->picture->texels);
    const auto cancelled = wait(*studio, studio->ask({Kind::CancelLoading}),
                                [](const Shown& s) { return s.facts.activity.empty(); });
    EXPECT_EQ(cancelled->facts.scene, first->facts.scene);
    const auto failed = wait(*studio, studio->ask({.kind = Kind::Open, .file = "none.gltf"}),
                             [](const Shown& s) { return !s.facts.fault.empty(); });
    EXPECT_THAT(failed->facts.fault, HasSubstr("none.gltf"));
    EXPECT_EQ(failed->facts.scenesShown, 1);
    go = true;
    const auto opened = wait(*studio, studio->ask({.kind = Kind::Open, .file = "builtin:lab-mirror"}),
                             [](const Shown& s) { return s.facts.scenesShown == 2; });
    EXPECT_NE(opened->facts.scene, first->facts.scene);
    EXPECT_TRUE(opened->facts.fault.empty());
    studio->finish();
}

TEST_F(StudioTest, AMissingFileIsToldBeforeTheFrameEnds) {
    if (wantedDevice() != "cpu") GTEST_SKIP() << "NOT TESTED: only frames on CPUs are interrupted.";
    StudioSettings settings = small();
    settings.samples = 400;
    settings.resolution = Resolution::Full;
    const auto studio = make(settings);
    rest(*studio);
    wait(*studio, studio->edit({{"seed", 3}}), [](const Shown& s) { return s.facts.computing; });
    const auto failed = wait(*studio, studio->ask({.kind = Kind::Open, .file = "none.gltf"}),
                             [](const Shown& s) { return !s.facts.fault.empty(); });
    EXPECT_THAT(failed->facts.fault, HasSubstr("none.gltf"));
    EXPECT_TRUE(failed->facts.computing);
    const auto second = rest(*studio);
    EXPECT_EQ(second->facts.framesEver, failed->facts.framesEver + 1);
    EXPECT_EQ(second->facts.fault, failed->facts.fault);
    studio->finish();
}

TEST_F(StudioTest, TellsWhatWasAddedToAScene) {
    const auto studio = make(small(), [](const scene::SceneSource& source, const Progress& progress) {
        if (source.scene == "builtin:lab-mirror") log::warn("a soft sky was added");
        return scene::openScene(source, progress);
    });
    EXPECT_TRUE(rest(*studio)->facts.notes.empty());
    const int shown = studio->shown()->facts.scenesShown;
    const auto noted = wait(*studio, studio->ask({.kind = Request::Kind::Open, .file = "builtin:lab-mirror"}),
                            [&](const Shown& s) { return s.facts.scenesShown > shown; });
    EXPECT_THAT(noted->facts.notes, testing::ElementsAre("a soft sky was added"));
    const auto next = wait(*studio, studio->ask({.kind = Request::Kind::Open, .file = "builtin:cornell"}),
                           [&](const Shown& s) { return s.facts.scenesShown > shown + 1; });
    EXPECT_TRUE(next->facts.notes.empty());
    studio->finish();
}

/// A hand that drags a colour asks for many scenes. None but the last is needed.
TEST_F(StudioTest, OneSceneIsLoadedAtATime) {
    std::atomic<int> running = 0, most = 0, loads = 0;
    const auto studio = make(small(), [&](const scene::SceneSource& source, const Progress& progress) {
        const std::shared_ptr<void> atEnd(nullptr, [&](void*) { --running; });
        most = std::max(most.load(), ++running);
        ++loads;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        return scene::openScene(source, progress);
    });
    rest(*studio);
    uint64_t last = 0;
    for (int i = 1; i <= 20; ++i) {
        last = studio->edit({{"background", {0.1 * i, 0.5, 0.5}}});
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    const auto shown = wait(*studio, last, [](const Shown& s) { return s.facts.activity.empty(); });
    EXPECT_EQ(shown->state.lights.background.r, 2.0f);
    EXPECT_EQ(shown->facts.fault, "");
    EXPECT_GE(shown->facts.scenesShown, 2);
    EXPECT_EQ(most, 1);
    EXPECT_LT(loads, 20);
    studio->finish();
}

/// Changes while a scene is loaded are made to that one, and what is given up leaves the lights as they are.
TEST_F(StudioTest, ChangesWhileASceneIsLoadedAddUp) {
    std::atomic<bool> go = true;
    const auto studio = make(small(), [&](const scene::SceneSource& source, const Progress& progress) {
        while (!go) {
            progress.at(0.0);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return scene::openScene(source, progress);
    });
    const size_t own = rest(*studio)->state.lights.lights.size();
    const auto lights = [](size_t count) {
        return [count](const Shown& s) {
            return s.facts.activity.empty() && s.state.lights.lights.size() == count;
        };
    };
    go = false;
    studio->ask({Kind::AddPoint});
    const uint64_t sun = studio->ask({Kind::AddSun});
    wait(*studio, sun, [](const Shown& s) { return s.facts.activity == "changing the lights"; });
    go = true;
    const auto lit = wait(*studio, sun, lights(own + 2));
    const int first = lit->state.lights.firstAdded;

    go = false;
    wait(*studio, studio->ask({.kind = Kind::RemoveLamp, .index = first}),
         [](const Shown& s) { return !s.facts.activity.empty(); });
    const auto kept = wait(*studio, studio->ask({Kind::CancelLoading}), lights(own + 2));
    const auto bright = rest(*studio);
    json dimmed = toJson(kept->state)["lights"];
    for (json& light : dimmed) light["brightness"] = 0.25;
    EXPECT_NE(rest(*studio, studio->edit({{"lights", dimmed}}))->picture->texels, bright->picture->texels);

    go = false;
    studio->ask({.kind = Kind::RemoveLamp, .index = first});
    studio->ask({.kind = Kind::RemoveLamp, .index = first});  // is going already
    const uint64_t removed = studio->ask({.kind = Kind::RemoveLamp, .index = first + 1});
    wait(*studio, removed, [](const Shown& s) { return !s.facts.activity.empty(); });
    go = true;
    const auto dark = wait(*studio, removed, lights(own));
    for (const scene::LightControl& light : dark->state.lights.lights) EXPECT_EQ(light.brightness, 0.25f);

    go = false;
    studio->ask({.kind = Kind::Open, .file = "builtin:lab-mirror"});
    const uint64_t added = studio->ask({Kind::AddSun});
    wait(*studio, added, [](const Shown& s) { return s.facts.activity == "loading builtin:lab-mirror"; });
    go = true;
    const auto opened = wait(*studio, added, [](const Shown& s) { return s.facts.activity.empty(); });
    EXPECT_EQ(opened->facts.message, "opened builtin:lab-mirror");
    EXPECT_THAT(opened->facts.files, testing::ElementsAre("builtin:lab-mirror"));
    const LightDesk& desk = opened->state.lights;
    EXPECT_TRUE(std::ranges::any_of(desk.lights, [&](const auto& light) { return desk.isAdded(light); }));
    studio->finish();
}

/// A scene whose loading has come to 25 %, until it is given up.
scene::Scene loadForever(const scene::SceneSource&, const Progress& progress) {
    for (;;) {
        progress.part(0.0, 0.5).at(0.85);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

TEST_F(StudioTest, TellsHowFarLoadingIs) {
    std::atomic<bool> ended = false;
    const auto studio = make(small(), [&](const scene::SceneSource& source, const Progress& progress) {
        if (source.scene != "builtin:lab-mirror") return scene::openScene(source, progress);
        try {
            return loadForever(source, progress);
        } catch (const Cancelled&) {
            ended = true;
            throw;
        }
    });
    rest(*studio);
    const auto loading = wait(*studio, studio->ask({.kind = Kind::Open, .file = "builtin:lab-mirror"}),
                              [](const Shown& s) { return s.facts.percent == 25; });
    EXPECT_EQ(loading->facts.activityText(), "loading builtin:lab-mirror, 25 %");
    wait(*studio, studio->ask({Kind::CancelLoading}), [&](const Shown& s) {
        return s.facts.activity.empty() && s.facts.fault.empty() && s.facts.scenesShown == 1;
    });
    studio->finish();  // ends the thread, too
    EXPECT_TRUE(ended);
}

TEST_F(StudioTest, TheFirstSceneCanBeGivenUp) {
    const auto studio = make(small(), [](const scene::SceneSource& source, const Progress& progress) {
        return source.scene == small().source.scene ? loadForever(source, progress)
                                                    : scene::openScene(source, progress);
    });
    wait(*studio, 0, [](const Shown& s) { return s.facts.percent == 25; });
    wait(*studio, studio->ask({Kind::CancelLoading}),
         [](const Shown& s) { return s.facts.activity.empty(); });
    const auto opened = wait(*studio, studio->ask({.kind = Kind::Open, .file = "builtin:lab-mirror"}),
                             [](const Shown& s) { return s.facts.scenesShown == 1 && s.picture; });
    EXPECT_FALSE(opened->facts.scene.empty());
    studio->finish();
}

TEST_F(StudioTest, TheFirstSceneEndsIt) {
    const auto studio = make(small("none.gltf"));
    EXPECT_THROW(
        {
            while (!studio->hasEnded()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            studio->finish();
        },
        InputError);
}

/// The method before is rendered until the network is there; one that cannot be read changes nothing.
TEST_F(StudioTest, NetworksLoadBesideTheRendering) {
    std::atomic<bool> go = false;
    StudioSettings settings = small();
    settings.resolution = Resolution::Full;
    settings.weights = std::filesystem::path(LIMPID_SOURCE_DIR) / "tests/data/kpcn_small.safetensors";
    settings.loadNetworks = [&](gpu::Device& device, const denoise::Denoiser* denoiser,
                                const std::filesystem::path& weights, const denoise::DenoiserSettings& with,
                                const Progress& progress) {
        if (with.kpcn.cis565) return loadNetworks(device, denoiser, "none.safetensors", with, progress);
        while (!go) {
            progress.at(0.4);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return loadNetworks(device, denoiser, weights, with, progress);
    };
    const auto studio = make(settings);
    const auto filtered = rest(*studio, studio->edit({{"denoiser", "atrous"}}));
    const auto loading = wait(*studio, studio->edit({{"denoiser", "kpcn"}}),
                              [](const Shown& s) { return s.facts.percent == 40; });
    EXPECT_EQ(loading->facts.activityText(), "loading the network, 40 %");
    EXPECT_EQ(loading->picture->texels, filtered->picture->texels);
    const auto still = rest(*studio, studio->edit({{"seed", 3}}));
    EXPECT_NE(still->picture->texels, filtered->picture->texels) << "it answers meanwhile";
    EXPECT_EQ(toJson(still->state)["denoiser"], "kpcn");
    const auto given = rest(*studio, studio->ask({Kind::CancelLoading}));
    EXPECT_EQ(toJson(given->state)["denoiser"], "atrous");
    EXPECT_EQ(given->facts.message, "cancelled");
    EXPECT_EQ(given->facts.activity, "");

    const auto broken = wait(*studio, studio->edit({{"denoiser", "kpcn"}, {"kpcn.cis565", true}}),
                             [](const Shown& s) { return !s.facts.fault.empty(); });
    EXPECT_THAT(broken->facts.fault, HasSubstr("none.safetensors"));
    EXPECT_EQ(toJson(broken->state)["denoiser"], "atrous");

    wait(*studio, studio->edit({{"kpcn.cis565", false}, {"compare", "kpcn"}}),
         [](const Shown& s) { return s.facts.percent == 40; });
    EXPECT_FALSE(rest(*studio, studio->edit({{"seed", 4}}))->compared) << "it waits for its network";
    go = true;
    wait(*studio, 0, [](const Shown& s) { return s.compared != nullptr; });
    const auto denoised = rest(*studio, studio->edit({{"denoiser", "kpcn"}, {"compare", "nothing"}}));
    EXPECT_EQ(denoised->facts.activity, "");
    EXPECT_NE(denoised->picture->texels, still->picture->texels);
    studio->finish();
}

}  // namespace
}  // namespace limpid::studio
