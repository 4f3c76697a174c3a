// The numbers of `limpid bench quality` as text on stdout.
#pragma once

#include "lab/quality/quality_run.h"

namespace limpid::cli {

/// The device, and what the columns of printSequence() are.
void printHead(const QualityRun& run);

/// A line for each method; at once, since a run may take long.
void printSequence(const MeasuredSequence& measured);

/// The methods in the order of rankMethods().
void printRanking(const QualityRun& run);

}  // namespace limpid::cli
