#include "studio/compare/history_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "denoise/stages/reproject/reasons_params.h"
#include "studio/compare/pixel_at.h"

namespace limpid::studio {
namespace {

using namespace denoise;

constexpr int tapCount = 4;

struct Cause {
    const char* words;
    int taps;  ///< that it applies to
};

/// Those that lead to a rejection, the most frequent first, and the number of taps with a weight.
struct Causes {
    std::vector<Cause> all;
    int used = 0;
};

bool applies(uint32_t tap, uint32_t cause) {
    return cause < TAP_OUTSIDE ? tap < TAP_OUTSIDE && (tap & cause) != 0 : tap == cause;
}

Causes causesOf(uint32_t reason) {
    constexpr std::array<std::pair<uint32_t, const char*>, 8> known{{
        {TAP_INSTANCE, "other object"},
        {TAP_NORMAL, "normal differs"},
        {TAP_DISTANCE, "depth differs"},
        {TAP_OUTSIDE, "outside the previous picture"},
        {TAP_NOTHING_SEEN, "no surface there"},
        {TAP_LOBE, "reflects in another direction"},
        {TAP_NO_HISTORY, "no valid sample there"},
        {TAP_LIGHT, "weight below 1 %"},
    }};
    std::array<uint32_t, tapCount> taps{};
    Causes causes;
    for (int i = 0; i < tapCount; ++i) {
        taps[static_cast<size_t>(i)] = reason >> (REASON_TAPS + REASON_TAP_BITS * i) & REASON_TAP_MASK;
        causes.used += taps[static_cast<size_t>(i)] != TAP_UNUSED;
    }
    for (const auto& [code, words] : known) {
        const auto count =
            std::ranges::count_if(taps, [&, code = code](uint32_t tap) { return applies(tap, code); });
        if (count > 0) causes.all.push_back({words, static_cast<int>(count)});
    }
    std::ranges::stable_sort(causes.all, std::ranges::greater(), &Cause::taps);
    return causes;
}

/// "normal differs (3 of 4 taps), other object (1 of 4 taps)"; without counts if one cause explains all.
std::string causesText(uint32_t reason) {
    const Causes causes = causesOf(reason);
    if (causes.all.size() == 1 && causes.all[0].taps == causes.used) return causes.all[0].words;
    std::string text;
    for (const Cause& cause : causes.all) {
        text += fmt::format("{}{} ({} of {} taps)", text.empty() ? "" : ", ", cause.words, cause.taps,
                            causes.used);
    }
    return text;
}

std::string framesText(uint32_t frames) {
    const char* const more = frames == REASON_MAX_FRAMES ? " or more" : "";
    return fmt::format("{}{} {}", frames, more, frames == 1 ? "frame" : "frames");
}

std::string keptText(uint32_t reason, uint32_t now, uint32_t whole) {
    const uint32_t kind = reason & REASON_MASK;
    std::string text = kind == REASON_SHORTENED
                           ? fmt::format("history shortened: light changed, {} of {}", now, framesText(whole))
                           : "history kept: " + framesText(now);
    if (kind == REASON_SEARCHED) text += ", from a pixel nearby";
    if (reason & REASON_REFLECTED) text += ", along the reflection";
    if (const std::string others = causesText(reason); !others.empty()) text += "; not used: " + others;
    return text;
}

}  // namespace

std::string reasonText(uint32_t reason, uint32_t frames) {
    switch (reason & REASON_MASK) {
        case REASON_NOTHING_SEEN:
            return "no surface";
        case REASON_CUT:
            return "no history: first frame after a cut";
        case REASON_NO_MOTION:
            return "history rejected: no valid motion (behind the previous camera?)";
        case REASON_OFF_SCREEN:
            return "history rejected: outside the previous picture";
        case REASON_REJECTED:
            return "history rejected: " + causesText(reason);
        default:
            return keptText(reason, frames & REASON_MAX_FRAMES, frames >> REASON_WHOLE);
    }
}

std::string historyText(const HistoryReasons& reasons, const std::array<float, 2>& position) {
    if (reasons.signals.empty() || reasons.extent.width == 0 || reasons.extent.height == 0) return {};
    const size_t column = pixelAt(position[0], reasons.extent.width),
                 row = pixelAt(position[1], reasons.extent.height);
    const size_t at = 2 * (row * reasons.extent.width + column);
    std::vector<std::string> texts;
    for (const HistoryReasons::Signal& signal : reasons.signals)
        texts.push_back(reasonText(signal.texels.at(at), signal.texels.at(at + 1)));
    if (std::ranges::all_of(texts, [&](const std::string& text) { return text == texts[0]; }))
        return texts[0];
    std::string all;
    for (size_t i = 0; i < texts.size(); ++i)
        all += fmt::format("{}{}: {}", i == 0 ? "" : "\n", reasons.signals[i].name, texts[i]);
    return all;
}

}  // namespace limpid::studio
