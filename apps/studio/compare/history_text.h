// Says in words why a pixel's history was kept or rejected.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "renderer/frame/history_reasons.h"

namespace limpid::studio {

/// One signal's sentence, such as "history kept: 14 frames" or "history rejected: normal differs (3 of 4
/// taps), other object (1 of 4 taps)". Taps with a bilinear weight of 0 are not counted. The arguments are
/// the two words of a pixel (denoise/stages/reproject/reasons_params.h).
std::string reasonText(uint32_t reason, uint32_t frames);

/// The same for a pixel: one line, or one for each signal if they differ ("diffuse: ..."). Empty if there are
/// no signals. `position`: from 0 to 1.
std::string historyText(const HistoryReasons& reasons, const std::array<float, 2>& position);

}  // namespace limpid::studio
