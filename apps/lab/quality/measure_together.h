// `limpid bench quality` by the processes of a cluster. Pieces are sequences.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lab/quality/quality_output.h"
#include "lab/quality/quality_run.h"

namespace limpid::cli {

/// Shares the sequences out; `measure` measures one. Process 0 shows and writes what it would have alone.
void measureTogether(const QualityRun& head, const std::vector<QualitySequence>& sequences,
                     const QualityDestinations& destinations,
                     const std::function<QualityOutcome(size_t)>& measure);

}  // namespace limpid::cli
