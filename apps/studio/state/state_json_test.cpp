#include "studio/state/state_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "base/error.h"
#include "renderer/method/parameters.h"

namespace limpid::studio {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string faultOf(State& state, const json& changes) {
    try {
        studio::apply(state, changes);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "no error";
}

/// A value that differs from the one there is.
json otherValue(const Field& field, const json& now) {
    switch (field.kind) {
        case Field::Kind::Bool:
            return !now.get<bool>();
        case Field::Kind::Choice:
            return now == field.choices.front() ? field.choices.back() : field.choices.front();
        case Field::Kind::Int:
        case Field::Kind::Index:
            return now == field.maximum ? field.minimum : field.maximum;
        case Field::Kind::Float:
            return now == field.maximum ? field.minimum : double{static_cast<float>(field.maximum)};
        case Field::Kind::Vector:
            return json::array({1.5, -2.25, 3.0});
        case Field::Kind::Text:
            return "svgf/variance";
        case Field::Kind::Background:
            return json::array({0.5, 0.25, 1.0});
        case Field::Kind::Extent:
            return json::array({640, 480});
        case Field::Kind::Settings:
            return json::array({"integrator=ao", "denoiser=svgf", "jitter=off", "svgf.levels=3"});
        case Field::Kind::Lights:
            break;
    }
    json lights = now;
    for (json& light : lights) light["brightness"] = 7.0;
    return lights;
}

State stateWithLights() {
    State state;
    scene::LightControl lamp;
    lamp.name = "lamp";
    state.lights.lights = state.lights.original = {lamp, lamp};
    return state;
}

TEST(StateJson, EachDenoiserAndIntegratorIsExplained) {
    for (const Field& field : fields()) {
        EXPECT_TRUE(field.choiceHelp.empty() || field.choiceHelp.size() == field.choices.size()) << field.key;
        for (const std::string& help : field.choiceHelp) EXPECT_GT(help.size(), 10u) << field.key;
    }
    EXPECT_FALSE(findField("denoiser")->choiceHelp.empty());
    EXPECT_FALSE(findField("integrator")->choiceHelp.empty());
}

TEST(StateJson, EveryFieldChangesAloneAndComesBack) {
    const State initial = stateWithLights();
    const json before = toJson(initial);
    std::set<std::string> keys;
    for (const Field& field : fields()) {
        SCOPED_TRACE(field.key);
        EXPECT_TRUE(keys.insert(field.key).second) << "twice";
        EXPECT_FALSE(field.label.empty());
        EXPECT_FALSE(field.help.empty());
        State state = initial;
        const json value = otherValue(field, before.at(field.key));
        studio::apply(state, {{field.key, value}});
        const json after = toJson(state);
        EXPECT_EQ(after.at(field.key), value);
        // An integrator without denoising switches the denoiser off, and the reverse.
        if (field.key != "integrator" && field.key != "denoiser") {
            EXPECT_EQ(changesOf(before, after).size(), 1u) << changesOf(before, after);
        }
        studio::apply(state, changesOf(after, before));
        EXPECT_EQ(toJson(state), before);
    }
}

TEST(StateJson, HasAllParameters) {
    for (const ParamGroup& group : paramGroups()) {
        for (const ParamInfo& info : group.infos)
            EXPECT_TRUE(findField(group.name + "." + info.name)) << info.name;
    }
    EXPECT_FALSE(findField("nothing"));
}

TEST(StateJson, WhatTheSceneDecidesHasNoDefault) {
    for (const char* key : {"exposure", "eye", "fov", "lights"})
        EXPECT_TRUE(findField(key)->defaultValue.is_null()) << key;
    for (const char* key : {"seed", "denoiser", "tone_curve"})
        EXPECT_FALSE(findField(key)->defaultValue.is_null()) << key;
}

TEST(StateJson, WhatDoesNotFitChangesNothing) {
    State state = stateWithLights();
    const json before = toJson(state);
    EXPECT_THAT(faultOf(state, {{"seed", 5}, {"nothing", 1}}), HasSubstr("nothing"));
    EXPECT_THAT(faultOf(state, {{"seed", 5}, {"exposure", 99.0}}), HasSubstr("exposure"));
    EXPECT_THAT(faultOf(state, {{"seed", "five"}}), HasSubstr("wrong type"));
    EXPECT_THAT(faultOf(state, {{"samples", 1.5}}), HasSubstr("no integer"));
    EXPECT_THAT(faultOf(state, {{"samples", json()}}), HasSubstr("samples"));
    EXPECT_THAT(faultOf(state, {{"denoiser", "magic"}}), HasSubstr("magic"));
    EXPECT_THAT(faultOf(state, {{"svgf.levels", 10000}}), HasSubstr("svgf.levels"));
    EXPECT_THAT(faultOf(state, {{"svgf.levels", json::array()}}), HasSubstr("svgf.levels"));
    EXPECT_THAT(faultOf(state, {{"eye", {1, 2}}}), HasSubstr("three numbers"));
    EXPECT_THAT(faultOf(state, {{"eye", {1, 2, 1e300}}}), HasSubstr("eye"));
    EXPECT_THAT(faultOf(state, {{"eye", {1, 2, "3"}}}), HasSubstr("eye"));
    EXPECT_THAT(faultOf(state, {{"eye", 3}}), HasSubstr("eye"));
    EXPECT_THAT(faultOf(state, {{"svgf.alpha", 1e300}}), HasSubstr("svgf.alpha"));
    EXPECT_THAT(faultOf(state, {{"viewport", {100000, 1}}}), HasSubstr("viewport"));
    EXPECT_THAT(faultOf(state, {{"viewport", {-1, 1}}}), HasSubstr("viewport"));
    EXPECT_THAT(faultOf(state, {{"lights", json::array()}}), HasSubstr("lights"));
    EXPECT_THAT(faultOf(state, json::array()), HasSubstr("object"));
    EXPECT_EQ(toJson(state), before);
}

/// A control clamps what is typed to the ends, as floats: some of them are beyond the decimal numbers.
TEST(StateJson, BothEndsOfARangeBelongToIt) {
    for (const Field& field : fields()) {
        if (field.kind != Field::Kind::Float) continue;
        for (const double end : {field.minimum, field.maximum}) {
            State state;
            EXPECT_EQ(faultOf(state, {{field.key, end}}), "no error") << field.key;
            EXPECT_EQ(faultOf(state, {{field.key, static_cast<float>(end)}}), "no error") << field.key;
        }
    }
    State state;
    EXPECT_THAT(faultOf(state, {{"fov", 0.0099}}), HasSubstr("fov"));
}

TEST(StateJson, NumbersOfLightsAreLimited) {
    State state = stateWithLights();
    json lights = toJson(state).at("lights");
    lights[0]["brightness"] = 1e300;
    lights[0]["turn"] = -1e300;
    EXPECT_EQ(faultOf(state, {{"lights", lights}}), "no error");
    EXPECT_EQ(state.lights.lights[0].brightness, 1e9f);
    EXPECT_EQ(state.lights.lights[0].turn, -360.0f);
}

TEST(StateJson, ADenoiserOfOneChannelBringsAmbientOcclusion) {
    State state;
    studio::apply(state, {{"denoiser", "visibility"}});
    EXPECT_EQ(state.render.pipeline, parsePipeline("ao", "visibility"));
    studio::apply(state, {{"integrator", "path"}});
    EXPECT_EQ(state.render.pipeline, parsePipeline("path"));
}

TEST(StateJson, PreviewRemembersThePipelineBefore) {
    State state;
    studio::apply(state, {{"integrator", "ao"}});
    studio::apply(state, {{"integrator", "preview"}});
    EXPECT_TRUE(state.isPreview());
    state.setPreview(false);
    EXPECT_EQ(state.render.pipeline.integrator, Integrator::AmbientOcclusion);

    // The window sends all fields that the preview changes.
    state.render.pipeline = parsePipeline("path", "svgf");
    State shown = state;
    shown.setPreview(true);
    studio::apply(state, changesOf(toJson(state), toJson(shown)));
    EXPECT_TRUE(state.isPreview());
    state.setPreview(false);
    EXPECT_EQ(state.render.pipeline, parsePipeline("path", "svgf"));
}

}  // namespace
}  // namespace limpid::studio
