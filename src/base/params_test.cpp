#include "base/params.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace limpid {
namespace {

struct Settings {
    int levels = 5;
    float sigma = 0.5f;
    bool clamp = false;
};

ParamTable<Settings> table() {
    ParamTable<Settings> t("demo");
    t.add("levels", &Settings::levels, 1, 8, "", "levels");
    t.add("sigma", &Settings::sigma, 0.0, 10.0, "pixels", "width");
    t.add("clamp", &Settings::clamp, "clamp");
    return t;
}

TEST(Params, SetsWhatItNamesAndKeepsTheRest) {
    Settings s;
    EXPECT_TRUE(table().set(s, "levels", "7"));
    EXPECT_TRUE(table().set(s, "clamp", "on"));
    EXPECT_EQ(s.levels, 7);
    EXPECT_TRUE(s.clamp);
    EXPECT_FLOAT_EQ(s.sigma, 0.5f);
    EXPECT_FALSE(table().set(s, "nothing", "1"));
}

TEST(Params, RefusesBadTextAndValuesOutOfRange) {
    Settings s;
    for (const char* text : {"", "x", "9", "0", "3.5", "4 "})
        EXPECT_THROW(table().set(s, "levels", text), UsageError);
    for (const char* text : {"nan", "inf", "-1", "1,5"})
        EXPECT_THROW(table().set(s, "sigma", text), UsageError);
    EXPECT_THROW(table().set(s, "clamp", "maybe"), UsageError);
    EXPECT_EQ(s.levels, 5);
}

TEST(Params, BothEndsOfARangeBelongToIt) {
    // Some of these change when rounded to float.
    for (const double end : {1e-4, 1e-9, 0.01, 1e-6}) {
        ParamTable<Settings> t("demo");
        t.add("sigma", &Settings::sigma, end, 2.0 * end, "", "width");
        Settings s;
        for (const double value : {end, 2.0 * end}) EXPECT_TRUE(t.set(s, "sigma", fmt::format("{}", value)));
        for (const double value : {0.999 * end, 2.001 * end})
            EXPECT_THROW(t.set(s, "sigma", fmt::format("{}", value)), UsageError) << value;
    }
}

TEST(Params, ParsesAssignments) {
    const Assignment a = parseAssignment("svgf.phi_color=1.5");
    EXPECT_EQ(a.group, "svgf");
    EXPECT_EQ(a.name, "phi_color");
    EXPECT_EQ(a.value, "1.5");
    for (const char* text : {"", "a=1", "a.b", ".b=1", "a.=1", "=a.b"})
        EXPECT_THROW(parseAssignment(text), UsageError);
}

}  // namespace
}  // namespace limpid
