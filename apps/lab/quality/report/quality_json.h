// The numbers of `limpid bench quality` as JSON: what --json prints, and what its page shows.
#pragma once

#include <nlohmann/json.hpp>

#include "lab/quality/quality_run.h"

namespace limpid::cli {

/// Numbers that there are not, or that are infinite (PSNR of equal pictures), are null.
nlohmann::ordered_json qualityJson(const QualityRun& run);

}  // namespace limpid::cli
