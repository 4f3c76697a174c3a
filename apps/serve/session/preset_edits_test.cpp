#include "serve/session/preset_edits.h"

#include <gtest/gtest.h>

#include "renderer/method/presets.h"
#include "studio/state/state_json.h"

namespace limpid::serve {
namespace {

using nlohmann::json;

TEST(PresetEdits, DoWhatThePresetsDo) {
    const json edits = presetEdits();
    ASSERT_EQ(edits.size(), presets().size());
    studio::State state;
    for (size_t i = 0; i < edits.size(); ++i) {
        const Preset& preset = presets()[i];
        EXPECT_EQ(edits[i].at("name"), preset.name);
        EXPECT_EQ(edits[i].at("help"), preset.help);
        // One after another on the same state: an earlier one leaves nothing.
        studio::apply(state, edits[i].at("changes"));
        RenderSettings expected;
        expected.pipeline = preset.pipeline();
        applyOnlyPreset(expected, preset.name);
        EXPECT_EQ(state.render.pipeline, expected.pipeline) << preset.name;
        for (const auto& [key, value] : edits[i].at("changes").items())
            EXPECT_EQ(studio::toJson(state).at(key), value) << preset.name << ' ' << key;
        studio::State other;
        other.render = expected;
        other.jitter = state.jitter;
        json was = studio::toJson(state), is = studio::toJson(other);
        EXPECT_EQ(was, is) << preset.name;
        const Jitter jitter =
            state.jitter == 0 ? defaultJitter(state.render.pipeline) : static_cast<Jitter>(state.jitter - 1);
        EXPECT_EQ(jitter, preset.jitter) << preset.name;
    }
}

TEST(PresetEdits, NameThePipelinesThatTheyAreFor) {
    for (const json& edit : presetEdits()) {
        const Preset& preset = findPreset(edit.at("name").get<std::string>());
        ASSERT_FALSE(edit.at("pipelines").empty());
        for (const json& name : edit.at("pipelines")) {
            const auto text = name.get<std::string>();
            const size_t plus = text.find('+');
            EXPECT_TRUE(preset.isFor(parsePipeline(text.substr(0, plus), text.substr(plus + 1)))) << text;
        }
        EXPECT_EQ(edit.at("pipelines").front(), edit.at("changes").at("integrator").get<std::string>() + "+" +
                                                    edit.at("changes").at("denoiser").get<std::string>());
    }
}

}  // namespace
}  // namespace limpid::serve
