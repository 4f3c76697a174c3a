#include "studio/compare/history_text.h"

#include <gtest/gtest.h>

#include "denoise/stages/reproject/reasons_params.h"

namespace limpid::studio {
namespace {

using namespace denoise;

uint32_t with(uint32_t reason, std::array<uint32_t, 4> taps) {
    for (size_t i = 0; i < 4; ++i)
        reason |= taps[i] << (static_cast<size_t>(REASON_TAPS) + static_cast<size_t>(REASON_TAP_BITS) * i);
    return reason;
}
uint32_t frames(uint32_t now, uint32_t whole) {
    return now | whole << REASON_WHOLE;
}
std::string rejected(std::array<uint32_t, 4> taps) {
    return reasonText(with(REASON_REJECTED, taps), frames(1, 0));
}

TEST(HistoryText, WhatConcernsTheWholePixel) {
    EXPECT_EQ(reasonText(REASON_NOTHING_SEEN, 0), "no surface");
    EXPECT_EQ(reasonText(REASON_CUT, frames(1, 0)), "no history: first frame after a cut");
    EXPECT_EQ(reasonText(REASON_OFF_SCREEN, frames(1, 0)), "history rejected: outside the previous picture");
    EXPECT_EQ(reasonText(REASON_NO_MOTION, frames(1, 0)),
              "history rejected: no valid motion (behind the previous camera?)");
}

TEST(HistoryText, TheMostFrequentCauseComesFirst) {
    EXPECT_EQ(rejected({TAP_INSTANCE, TAP_NORMAL, TAP_NORMAL, TAP_NORMAL}),
              "history rejected: normal differs (3 of 4 taps), other object (1 of 4 taps)");
    EXPECT_EQ(rejected({TAP_DISTANCE, TAP_DISTANCE, TAP_DISTANCE, TAP_DISTANCE}),
              "history rejected: depth differs");
    EXPECT_EQ(rejected({TAP_OUTSIDE, TAP_NOTHING_SEEN, TAP_NO_HISTORY, TAP_OUTSIDE}),
              "history rejected: outside the previous picture (2 of 4 taps), no surface there (1 of 4 taps), "
              "no valid sample there (1 of 4 taps)");
}

TEST(HistoryText, ATapMayHaveSeveralCauses) {
    const uint32_t all = TAP_INSTANCE | TAP_NORMAL | TAP_DISTANCE | TAP_NO_HISTORY;
    EXPECT_EQ(
        rejected({all, TAP_INSTANCE, TAP_INSTANCE | TAP_DISTANCE, TAP_INSTANCE}),
        "history rejected: other object (4 of 4 taps), depth differs (2 of 4 taps), normal differs (1 of "
        "4 taps), no valid sample there (1 of 4 taps)");
}

/// Where nothing moves, one tap has all the weight.
TEST(HistoryText, TapsWithoutWeightAreNotCounted) {
    EXPECT_EQ(rejected({TAP_INSTANCE, TAP_UNUSED, TAP_UNUSED, TAP_UNUSED}), "history rejected: other object");
    EXPECT_EQ(rejected({TAP_LOBE, TAP_NORMAL, TAP_UNUSED, TAP_UNUSED}),
              "history rejected: normal differs (1 of 2 taps), reflects in another direction (1 of 2 taps)");
    EXPECT_EQ(rejected({TAP_LIGHT, TAP_INSTANCE, TAP_INSTANCE, TAP_INSTANCE}),
              "history rejected: other object (3 of 4 taps), weight below 1 % (1 of 4 taps)");
}

TEST(HistoryText, KeptHistoriesTellTheirLength) {
    const std::array<uint32_t, 4> fit{}, still{TAP_FITS, TAP_UNUSED, TAP_UNUSED, TAP_UNUSED};
    EXPECT_EQ(reasonText(with(REASON_KEPT, fit), frames(14, 14)), "history kept: 14 frames");
    EXPECT_EQ(reasonText(with(REASON_KEPT, still), frames(1, 1)), "history kept: 1 frame");
    EXPECT_EQ(reasonText(with(REASON_KEPT | REASON_REFLECTED, still), frames(4095, 4095)),
              "history kept: 4095 or more frames, along the reflection");
    EXPECT_EQ(reasonText(with(REASON_KEPT, {TAP_FITS, TAP_INSTANCE, TAP_FITS, TAP_INSTANCE}), frames(6, 6)),
              "history kept: 6 frames; not used: other object (2 of 4 taps)");
    EXPECT_EQ(
        reasonText(with(REASON_SEARCHED, {TAP_NORMAL, TAP_NORMAL, TAP_NORMAL, TAP_NORMAL}), frames(3, 3)),
        "history kept: 3 frames, from a pixel nearby; not used: normal differs");
    EXPECT_EQ(reasonText(with(REASON_SHORTENED, still), frames(2, 10)),
              "history shortened: light changed, 2 of 10 frames");
}

TEST(HistoryText, EachSignalHasALineIfTheyDiffer) {
    HistoryReasons reasons{.extent = {2, 2}, .signals = {{"diffuse", {}}, {"specular", {}}}};
    for (HistoryReasons::Signal& signal : reasons.signals) {
        for (int i = 0; i < 4; ++i) signal.texels.insert(signal.texels.end(), {REASON_NOTHING_SEEN, 0u});
    }
    reasons.signals[1].texels[4] = REASON_OFF_SCREEN;  // column 0, row 1
    EXPECT_EQ(historyText(reasons, {0.9f, 0.9f}), "no surface");
    EXPECT_EQ(historyText(reasons, {1.0f, 1.0f}), "no surface");
    EXPECT_EQ(historyText(reasons, {0.2f, 0.9f}),
              "diffuse: no surface\nspecular: history rejected: outside the previous picture");
    EXPECT_EQ(historyText({}, {0.5f, 0.5f}), "");
}

}  // namespace
}  // namespace limpid::studio
