// A whole studio on the test device: messages in, snapshots out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <thread>
#include <utility>

#include "base/error.h"
#include "image/io/picture.h"
#include "studio/compare/history_text.h"
#include "studio/state/state_file.h"
#include "studio/state/state_json.h"
#include "studio/studio_fixture.h"

namespace limpid::studio {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using Kind = Request::Kind;

/// For a display of a high dynamic range: what is up to white is as before, and what was clipped is not.
TEST_F(StudioTest, PicturesOfAHighRangeExceedWhite) {
    StudioSettings settings = small();
    settings.resolution = Resolution::Full;
    const auto studio = make(settings);
    rest(*studio);
    const auto clipped = rest(*studio, studio->edit({{"tone_curve", "none"}, {"exposure", 3.0}}));
    EXPECT_TRUE(clipped->picture->extended.empty());
    const auto extended = wait(*studio, studio->ask({.kind = Kind::Extended, .index = 1}),
                               [](const Shown& s) { return !s.picture->extended.empty(); });
    EXPECT_TRUE(extended->picture->texels.empty());
    ASSERT_EQ(extended->picture->extended.size(), clipped->picture->texels.size());
    size_t above = 0;
    for (size_t i = 0; i < clipped->picture->texels.size(); ++i) {
        const vec4 high = glm::unpackHalf4x16(extended->picture->extended[i]),
                   low = glm::unpackUnorm4x8(clipped->picture->texels[i]);
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(std::min(high[c], 1.0f), low[c], 1.5f / 255.0f) << i;
            above += high[c] > 1.01f ? 1 : 0;
        }
    }
    EXPECT_GT(above, 100u);
    // A frame that is rendered so is the same as one that is only exposed so.
    const auto again = wait(*studio, studio->ask({.kind = Kind::Reset}), [&](const Shown& s) {
        return !s.facts.computing && s.picture != extended->picture && s.facts.samplesInMean == 2;
    });
    ASSERT_FALSE(again->picture->extended.empty());
    EXPECT_NEAR(glm::unpackHalf4x16(again->picture->extended[1500]).g,
                glm::unpackHalf4x16(extended->picture->extended[1500]).g, 0.01f);
    wait(*studio, studio->ask({.kind = Kind::Extended, .index = 0}),
         [&](const Shown& s) { return s.picture->texels == clipped->picture->texels; });
}

TEST_F(StudioTest, EditsGesturesAndRequestsChangeThePicture) {
    const auto studio = make(small());
    const auto first = rest(*studio);
    EXPECT_EQ(first->picture->extent, (gpu::Extent{64, 48}));
    EXPECT_THAT(first->facts.scene, HasSubstr("ornell"));

    const auto seeded = rest(*studio, studio->edit({{"seed", 9}}));
    EXPECT_NE(seeded->picture->texels, first->picture->texels);
    EXPECT_EQ(rest(*studio, studio->edit({{"seed", 0}}))->picture->texels, first->picture->texels);

    const auto orbited = rest(*studio, studio->steer({.orbit = {0.3f, 0.1f}}));
    EXPECT_NE(orbited->state.pose, first->state.pose);
    EXPECT_NE(orbited->picture->texels, first->picture->texels);
    const auto placed = rest(*studio, studio->edit({{"eye", toJson(first->state)["eye"]}}));
    EXPECT_LT(glm::length(placed->state.pose.eye - first->state.pose.eye), 1e-4f);
    rest(*studio, studio->ask({Kind::ResetCamera}));

    const auto resized = rest(*studio, studio->edit({{"viewport", {40, 30}}}));
    EXPECT_EQ(resized->picture->extent, (gpu::Extent{40, 30}));

    const auto bad = wait(*studio, studio->edit({{"exposure", "bright"}}),
                          [](const Shown& s) { return !s.facts.fault.empty(); });
    EXPECT_THAT(bad->facts.fault, HasSubstr("exposure"));
    const auto good = rest(*studio, studio->edit({{"exposure", 3.0}}));
    EXPECT_TRUE(good->facts.fault.empty()) << "the old error stays";
    EXPECT_NE(good->picture->texels, resized->picture->texels);
    EXPECT_EQ(good->facts.frames, resized->facts.frames) << "another exposure needs no frame";
    studio->finish();
}

TEST_F(StudioTest, AnOpenShutterBlursWhatMovesAtRest) {
    const auto studio = make(small("builtin:cornell-moving"));
    const auto sharp = rest(*studio, studio->edit({{"time", 0.5}}));
    const auto blurred = rest(*studio, studio->edit({{"shutter", 8.0}}));
    EXPECT_NE(blurred->picture->texels, sharp->picture->texels);
    EXPECT_EQ(blurred->facts.samplesInMean, 2u);
    const auto earlier = rest(*studio, studio->edit({{"shutter_position", "end"}}));
    EXPECT_NE(earlier->picture->texels, blurred->picture->texels);
    const auto again = rest(*studio, studio->edit({{"shutter_position", "center"}}));
    EXPECT_EQ(again->picture->texels, blurred->picture->texels);
    // Both sides of a comparison see the scene at one moment.
    const auto compared = rest(*studio, studio->edit({{"compare", "ao"}}));
    EXPECT_EQ(compared->picture->texels, sharp->picture->texels);
    rest(*studio, studio->edit({{"compare", "nothing"}}));
    const auto later = rest(*studio, studio->edit({{"time", 0.7}}));
    EXPECT_NE(later->picture->texels, blurred->picture->texels);
    EXPECT_EQ(rest(*studio, studio->edit({{"time", 0.5}}))->picture->texels, blurred->picture->texels);
    const auto closed = rest(*studio, studio->edit({{"shutter", 0.0}}));
    EXPECT_EQ(closed->picture->texels, sharp->picture->texels);
    const auto other = rest(*studio, studio->edit({{"shutter_position", "start"}}));
    EXPECT_EQ(other->facts.framesBegun, closed->facts.framesBegun) << "a closed shutter has no position";
    studio->finish();
}

/// After a blurred frame the scene stands at the last sample's instant, which picking must not use.
TEST_F(StudioTest, TheCameraTurnsToWhatIsSeenAtTheFramesTime) {
    std::vector<vec3> targets;
    for (const double shutter : {0.0, 40.0}) {
        StudioSettings settings = small("builtin:cornell-moving");
        settings.resolution = Resolution::Full;
        const auto studio = make(settings);
        const auto start = rest(*studio, studio->edit({{"time", 0.5}, {"shutter", shutter}}));
        const auto turned = rest(*studio, studio->ask({.kind = Kind::Focus, .position = {0.61f, 0.73f}}));
        EXPECT_NE(turned->state.pose, start->state.pose);
        targets.push_back(turned->state.pose.target);
        studio->finish();
    }
    EXPECT_LT(glm::length(targets[1] - targets[0]), 1e-4f);
}

/// Compiling takes seconds on some drivers. Nobody should take that for a program that hangs.
TEST_F(StudioTest, ShadersThatAreCompiledAreTold) {
    const auto studio = make(small());
    const auto first = rest(*studio);
    std::atomic<int> told = 0;
    const uint64_t listener = studio->addListener([&] {
        const auto shown = studio->shown();
        if (!shown->facts.compiling) return;
        ++told;
        EXPECT_TRUE(shown->facts.computing);
        EXPECT_EQ(shown->picture, first->picture) << "the last picture stays";
    });
    const auto filtered = rest(*studio, studio->edit({{"denoiser", "atrous"}}));
    const int before = told;
    EXPECT_GE(before, 1);
    EXPECT_FALSE(filtered->facts.compiling);
    rest(*studio, studio->edit({{"seed", 3}}));
    EXPECT_EQ(told, before) << "they are there";
    studio->removeListener(listener);
    studio->finish();
}

/// While the pipelines of the first frame are compiled, the preview of the scene is shown.
TEST_F(StudioTest, APreviewComesFirst) {
    StudioSettings settings = small();
    settings.resolution = Resolution::Full;
    settings.maxSamples = 1;
    settings.preview = true;
    const auto preview = rest(*make(settings))->picture;
    settings.preview = false;
    const auto studio = make(settings);
    const auto first = wait(*studio, 0, [](const Shown& s) { return s.picture != nullptr; });
    EXPECT_EQ(first->picture->texels, preview->texels);
    EXPECT_TRUE(first->facts.computing);
    EXPECT_EQ(toJson(first->state)["integrator"], "path");
    const auto picture = rest(*studio);
    EXPECT_NE(picture->picture->texels, preview->texels);
    EXPECT_EQ(picture->facts.frames, 1u) << "the preview's frames do not count";
    EXPECT_FALSE(picture->facts.compiling);
    EXPECT_NE(picture->state.exposure, 0.0f) << "that of the preview is none";
    studio->finish();
}

/// The next frame begins before the picture of the last one is published; what is published stays the same.
TEST_F(StudioTest, FramesOverlapWithTheirPictures) {
    std::array<std::shared_ptr<const Shown>, 2> rested;
    for (const bool overlaps : {false, true}) {
        StudioSettings settings = small();
        settings.overlaps = overlaps;
        const auto studio = make(settings);
        rested[overlaps] = rest(*studio);
        // A hand moves the camera each time that it sees a new picture.
        std::shared_ptr<const Picture> last = rested[overlaps]->picture;
        uint64_t hand = studio->steer({.orbit = {0.01f, 0.0f}}), number = 0;
        std::atomic<int> pictures = 0, late = 0;
        const uint64_t listener = studio->addListener([&] {
            const auto shown = studio->shown();
            EXPECT_GT(shown->number, std::exchange(number, shown->number));
            if (std::exchange(last, shown->picture) == shown->picture || pictures == 20) return;
            late += shown->messages < hand;
            if (++pictures < 20) hand = studio->steer({.orbit = {0.01f, 0.0f}});
        });
        wait(*studio, 0, [&](const Shown&) { return pictures == 20; });
        studio->removeListener(listener);
        EXPECT_EQ(late > 10, overlaps)
            << late << " of 20 pictures were published when the next frame had begun";
        const auto moved = rest(*studio, hand);
        EXPECT_NE(moved->picture->texels, rested[overlaps]->picture->texels);
        EXPECT_EQ(rest(*studio, studio->ask({Kind::ResetCamera}))->picture->texels,
                  rested[overlaps]->picture->texels);
        studio->finish();
    }
    EXPECT_EQ(rested[0]->picture->texels, rested[1]->picture->texels);
}

/// Pictures that no device can have: the first one, and one of a setting that is changed.
TEST_F(StudioTest, AFrameThatCannotBeRenderedEndsNothing) {
    StudioSettings settings = small();
    settings.render.extent = {40000, 8};
    settings.resolution = Resolution::Quarter;
    const auto settled = [](const Shown& s) { return s.picture && !s.facts.computing; };
    auto studio = make(settings);
    const auto quarter = wait(*studio, 0, settled);
    EXPECT_EQ(quarter->picture->extent, (gpu::Extent{10000, 2}));
    const auto failed = wait(*studio, studio->edit({{"resolution", "full"}}),
                             [](const Shown& s) { return !s.facts.fault.empty(); });
    EXPECT_THAT(failed->facts.fault, HasSubstr("the settings before are used again"));
    EXPECT_EQ(toJson(failed->state)["resolution"], "1/4");
    EXPECT_TRUE(failed->state.running);
    const auto seeded = wait(*studio, studio->edit({{"seed", 3}}), settled);
    EXPECT_NE(seeded->picture->texels, quarter->picture->texels);
    EXPECT_EQ(seeded->facts.fault, "");
    studio->finish();

    settings.resolution = Resolution::Full;
    studio = make(settings);
    const auto stopped = wait(*studio, 0, [](const Shown& s) { return !s.facts.fault.empty(); });
    EXPECT_THAT(stopped->facts.fault, HasSubstr("rendering is stopped"));
    EXPECT_FALSE(stopped->state.running);
    const auto smaller = rest(*studio, studio->edit({{"viewport", {64, 48}}, {"running", true}}));
    EXPECT_EQ(smaller->facts.fault, "");
    studio->finish();
}

/// Who chooses a camera, or a path, can go back.
TEST_F(StudioTest, TheFreeCameraStaysWhereTheHandHasLeftIt) {
    const auto studio = make(small());
    const CameraPose home = rest(*studio)->state.pose;
    const auto orbited = rest(*studio, studio->steer({.orbit = {0.3f, 0.1f}}));
    const std::vector<std::string>& cameras = orbited->facts.cameras;
    const auto path = std::ranges::find(cameras, "orbit") - cameras.begin();
    EXPECT_NE(rest(*studio, studio->edit({{"camera", 1}}))->state.pose, orbited->state.pose);
    EXPECT_EQ(rest(*studio, studio->edit({{"camera", 0}}))->state.pose, orbited->state.pose);
    wait(*studio, studio->edit({{"camera", path}}), [](const Shown& s) { return s.state.playing; });
    const auto placed = rest(*studio, studio->edit({{"camera", 0},
                                                    {"playing", false},
                                                    {"eye", toJson(orbited->state)["target"]},
                                                    {"target", toJson(orbited->state)["eye"]}}));
    EXPECT_LT(glm::length(placed->state.pose.eye - orbited->state.pose.target), 1e-4f);
    const auto paused = rest(*studio, studio->edit({{"camera", path}, {"playing", false}}));
    EXPECT_EQ(paused->state.camera, path);
    EXPECT_FALSE(paused->state.playing) << "a state says that it rests";
    EXPECT_EQ(rest(*studio, studio->ask({Kind::ResetCamera}))->state.pose, home);

    const auto flat = rest(*studio, studio->edit({{"half_height", 0.5}}));
    EXPECT_EQ(flat->state.halfHeight, 0.5f);
    EXPECT_EQ(flat->state.pose, home);
    const auto nearer = rest(*studio, studio->steer({.zoom = 1.0f}));
    EXPECT_NE(nearer->state.halfHeight, 0.5f);
    EXPECT_NE(nearer->picture->texels, flat->picture->texels);
    EXPECT_EQ(rest(*studio, studio->edit({{"half_height", 0.0}}))->state.halfHeight, 0.0f);
    studio->finish();
}

bool hasText(const HistoryReasons& reasons, const std::string& wanted) {
    for (uint32_t y = 0; y < reasons.extent.height; ++y) {
        for (uint32_t x = 0; x < reasons.extent.width; ++x) {
            const std::array<float, 2> at{(static_cast<float>(x) + 0.5f) / 64.0f,
                                          (static_cast<float>(y) + 0.5f) / 48.0f};
            if (historyText(reasons, at).find(wanted) != std::string::npos) return true;
        }
    }
    return false;
}

/// One frame follows each edit or gesture.
TEST_F(StudioTest, TellsWhyHistoriesWereKeptOrRejected) {
    StudioSettings settings = small("builtin:cornell-moving");
    settings.resolution = Resolution::Full;
    settings.maxSamples = 1;
    const auto studio = make(settings);
    const auto first = rest(*studio, studio->edit({{"denoiser", "svgf"}, {"svgf.antilag", 0.0}}));
    EXPECT_FALSE(first->reasons) << "nobody has asked";
    const auto asked = rest(*studio, studio->edit({{"pass", "svgf/compose"}}));
    ASSERT_TRUE(asked->reasons) << "another frame was needed";
    EXPECT_EQ(asked->facts.frames, first->facts.frames + 1);
    EXPECT_THAT(historyText(*asked->reasons, {0.5f, 0.5f}), HasSubstr("history kept: "));
    EXPECT_FALSE(hasText(*asked->reasons, "rejected"));

    rest(*studio, studio->steer({.fly = {0.0f, 0.0f, 1.0f}}));  // frees the camera, and into the room
    const auto moved = rest(*studio, studio->steer({.look = {0.1f, 0.0f}, .fly = {0.1f, 0.0f, 0.0f}}));
    ASSERT_TRUE(moved->reasons);
    EXPECT_TRUE(hasText(*moved->reasons, "history rejected: outside the previous picture"));
    EXPECT_TRUE(hasText(*moved->reasons, "other object"));
    const auto cut = rest(*studio, studio->edit({{"time", 1.5}}));
    EXPECT_EQ(historyText(*cut->reasons, {0.5f, 0.5f}), "no history: first frame after a cut");

    const auto listed = rest(*studio, studio->edit({{"pass", "svgf/reasons diffuse"}}));
    EXPECT_THAT(listed->facts.images, testing::ElementsAre("svgf/diffuse reasons", "svgf/diffuse history",
                                                           HasSubstr("surfaces"), HasSubstr("moments")));
    EXPECT_EQ(listed->facts.frames, cut->facts.frames) << "the frame had it already";
    const auto closed = rest(*studio, studio->edit({{"pass", ""}}));
    EXPECT_FALSE(closed->reasons);
    rest(*studio, studio->edit({{"denoiser", "nano"}}));
    const auto network = rest(*studio, studio->edit({{"pass", "nano/filter 0"}}));
    EXPECT_TRUE(network->inspected);
    ASSERT_TRUE(network->reasons) << "those of SVGF, from which it goes on";
    EXPECT_THAT(historyText(*network->reasons, {0.5f, 0.5f}), HasSubstr("history"));
    rest(*studio, studio->edit({{"pass", ""}}));
    rest(*studio, studio->edit({{"denoiser", "bilateral"}}));
    const auto single = rest(*studio, studio->edit({{"pass", "bilateral"}}));
    EXPECT_TRUE(single->inspected);
    EXPECT_FALSE(single->reasons) << "it keeps no histories";
    studio->finish();
}

TEST_F(StudioTest, ProbesTellWhyTheHistoryWasKept) {
    StudioSettings settings = small();
    settings.resolution = Resolution::Full;
    const auto studio = make(settings);
    rest(*studio, studio->edit({{"denoiser", "temporal"}}));
    const Request probe{.kind = Kind::Probe, .position = {0.5f, 0.5f}};
    const auto told =
        wait(*studio, studio->ask(probe), [](const Shown& s) { return !s.facts.allValues.empty(); });
    EXPECT_THAT(told->facts.allValues, HasSubstr("pixel (32, 24)\nhistory kept: "));
    EXPECT_THAT(told->facts.allValues, HasSubstr("temporal/color: "));
    const Request other{.kind = Kind::Probe, .position = {0.1f, 0.5f}};
    const auto elsewhere = wait(*studio, studio->ask(other), [](const Shown& s) {
        return s.facts.allValues.starts_with("pixel (6, 24)");
    });
    EXPECT_EQ(elsewhere->facts.probedAt, other.position);
    EXPECT_TRUE(rest(*studio, studio->ask(other))->facts.allValues.empty());
    // Stopped, no frame is rendered for it.
    const auto paused = rest(*studio, studio->edit({{"running", false}, {"denoiser", "none"}}));
    const auto values =
        wait(*studio, studio->ask(probe), [](const Shown& s) { return !s.facts.allValues.empty(); });
    EXPECT_EQ(values->facts.framesEver, paused->facts.framesEver);
    studio->finish();
}

double meanDifference(const Picture& a, const Picture& b) {
    const auto *first = reinterpret_cast<const uint8_t*>(a.texels.data()),
               *second = reinterpret_cast<const uint8_t*>(b.texels.data());
    double sum = 0.0;
    for (size_t i = 0; i < 4 * a.texels.size(); ++i) sum += std::abs(int{first[i]} - int{second[i]});
    return sum / static_cast<double>(4 * a.texels.size());
}

/// Without their parts, these methods have nothing in common but their input: they must show the same.
TEST_F(StudioTest, DenoisersWithoutTheirPartsShowTheirInput) {
    StudioSettings settings = small();
    settings.resolution = Resolution::Full;  // else a busy machine shrinks some of the pictures
    const auto studio = make(settings);
    rest(*studio, studio->edit({{"jitter", "off"}, {"max_samples", 1}}));
    const json off{{"part.temporal", false}, {"part.spatial", false}, {"part.demodulation", false}};
    const json on{{"part.temporal", true}, {"part.spatial", true}, {"part.demodulation", true}};
    std::shared_ptr<const Picture> input;
    for (const char* denoiser : {"temporal", "svgf", "nano", "film", "atrous", "bilateral"}) {
        const auto whole = rest(*studio, studio->edit({{"denoiser", denoiser}}));
        const auto without = rest(*studio, studio->edit(off));
        if (!input) input = without->picture;
        EXPECT_LT(meanDifference(*without->picture, *input), 0.5) << denoiser;
        const bool ofOneFrame = std::string_view(denoiser) == "temporal";  // whose mean is that frame
        EXPECT_GT(meanDifference(*whole->picture, *input), ofOneFrame ? -1.0 : 2.0) << denoiser;
        rest(*studio, studio->edit(on));
    }
    studio->finish();
}

/// A picture that takes many seconds is given up for the camera, and the next one is coarse.
TEST_F(StudioTest, AHandInterruptsAPictureThatRests) {
    if (wantedDevice() != "cpu") GTEST_SKIP() << "NOT TESTED: only frames on CPUs are interrupted.";
    StudioSettings settings = small();
    settings.render.extent = {1600, 1200};
    settings.samples = 16;
    const auto studio = make(settings);
    // The coarse picture is there, and the full one is computed.
    const auto coarse = wait(*studio, 0, [](const Shown& s) {
        return s.picture && s.facts.computing && s.facts.extent == s.state.viewport;
    });
    EXPECT_LT(coarse->picture->extent.width, 1600u);
    const auto moved = wait(*studio, studio->steer({.orbit = {0.1f, 0.0f}}),
                            [&](const Shown& s) { return s.picture && s.picture != coarse->picture; });
    EXPECT_LT(moved->picture->extent.width, 1600u) << "the full picture was waited for";
    EXPECT_NE(moved->state.pose, coarse->state.pose);
    studio->finish();
}

/// What no `limpid render` makes again is written as a state, which shows the same picture.
TEST_F(StudioTest, TheCommandLineAlwaysWorks) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("limpid_state_test." + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder);
    const auto commandOf = [](Studio& studio) {
        return wait(studio, studio.ask({Kind::CommandLine}),
                    [](const Shown& s) { return s.facts.commands > 0; })
            ->facts.command;
    };
    StudioSettings settings = small("builtin:cornell-moving");
    settings.render.pipeline = parsePipeline("path", "svgf");
    auto studio = make(settings);
    rest(*studio);
    studio->steer({.orbit = {0.2f, 0.0f}});
    json lights = toJson(rest(*studio)->state)["lights"];
    lights[0]["brightness"] = 3.0;
    rest(
        *studio,
        studio->edit(
            {{"lights", lights}, {"exposure", 1.25}, {"svgf.levels", 3}, {"seed", 4}, {"half_height", 1.5}}));
    const std::string command = commandOf(*studio);
    EXPECT_THAT(command, HasSubstr("limpid view builtin:cornell-moving"));
    EXPECT_THAT(command, HasSubstr("--state state.json"));
    const auto shown = rest(*studio);
    studio->finish();

    StudioSettings again = small("builtin:cornell-moving");
    again.state = readStateFile("state.json");
    studio = make(again);
    const auto same = rest(*studio);
    json expected = toJson(shown->state), got = toJson(same->state);
    for (const char* const key : {"eye", "target", "up"}) {  // through sines and cosines
        for (size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(got[key][i].get<float>(), expected[key][i].get<float>(), 1e-5f) << key;
        got.erase(key);
        expected.erase(key);
    }
    EXPECT_EQ(got, expected);
    studio->finish();

    // Where no file may be written, the command writes it.
    again.writesFiles = false;
    std::filesystem::remove("state.json");
    studio = make(again);
    rest(*studio);
    studio->steer({.orbit = {0.2f, 0.0f}});
    const auto turned = rest(*studio, studio->edit({{"svgf.levels", 2}}));
    const std::string both = commandOf(*studio);
    EXPECT_FALSE(std::filesystem::exists("state.json"));
    const size_t end = both.find(" && limpid serve builtin:cornell-moving");
    ASSERT_NE(end, std::string::npos) << both;
    EXPECT_EQ(std::system(both.substr(0, end).c_str()), 0);
    json written = readStateFile("state.json");
    EXPECT_EQ(written, toJson(turned->state));
    studio->finish();
    again.writesFiles = true;

    again.state = {{"lights", json::array()}};
    studio = make(again);
    EXPECT_THROW(
        {
            while (!studio->hasEnded()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            studio->finish();
        },
        UsageError);
    std::ofstream("bad.json") << R"({"limpid_state": 1, "samples": "many"})";
    EXPECT_THROW(readStateFile("bad.json"), InputError);
    std::ofstream("none.json") << "[";
    EXPECT_THROW(readStateFile("none.json"), InputError);
    std::filesystem::current_path(before);
    std::filesystem::remove_all(folder);
}

/// Also on a slow device, and where the window is closed at once.
TEST_F(StudioTest, PicturesAreSavedInFullSize) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("limpid_studio_test." + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder);
    const auto studio = make(small());
    wait(*studio, 0, [](const Shown& s) { return s.picture != nullptr; });
    studio->steer({.orbit = {0.2f, 0.0f}});
    studio->ask({Kind::SavePng});
    studio->finish();
    const image::Image saved = image::readPicture(folder / "limpid.png").linear;
    EXPECT_EQ(saved.width, 64u);
    EXPECT_EQ(saved.height, 48u);
    std::filesystem::current_path(before);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace limpid::studio
