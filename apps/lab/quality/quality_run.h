// Everything that one run of `limpid bench quality` found out, and under which conditions.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "lab/quality/bench_quality.h"
#include "lab/quality/quality_sequences.h"

namespace limpid::cli {

struct MeasuredSequence {
    QualitySequence sequence;
    uint64_t triangles = 0;
    SequenceQuality quality;
};

struct SkippedSequence {
    std::string name, reason;
};

using QualityOutcome = std::variant<MeasuredSequence, SkippedSequence>;

struct QualityRun {
    std::string version, command;  ///< of Limpid; the command line that it was run with
    std::string device, driver, tracer;
    gpu::Extent extent;
    uint32_t samples = 1;  ///< per pixel and frame
    std::vector<MeasuredSequence> sequences;
    std::vector<SkippedSequence> skipped;
};

}  // namespace limpid::cli
