// What was measured of some sequences, from one process to another.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "lab/quality/quality_run.h"

namespace limpid::cli {

/// By the sequence's place in the run.
using QualityOutcomes = std::map<size_t, QualityOutcome>;

/// Numbers lie in it as in memory; both processes run the same version of Limpid.
std::vector<std::byte> encodeOutcomes(const QualityOutcomes& outcomes);
/// Throws Error if the message is damaged. Which sequence it was (MeasuredSequence::sequence) is not sent.
QualityOutcomes decodeOutcomes(std::span<const std::byte> message);

}  // namespace limpid::cli
