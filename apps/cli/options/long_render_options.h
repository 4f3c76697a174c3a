// --time-limit, --checkpoint, --resume and --shard: renders that take hours, or many machines.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "renderer/long/sums/accumulation_header.h"

namespace limpid::cli {

struct LongRenderChoice {
    double timeLimit = 0.0;  ///< seconds; 0: none
    std::string checkpoint;  ///< a file; "": none
    bool resume = false;
    std::string shard;  ///< I/N; "": all
};

void addLongRenderOptions(CLI::App& command, LongRenderChoice& choice);

/// Whether any of the four is chosen.
bool isLongRender(const LongRenderChoice& choice);

/// Of --shard I/N; 1/1 if it is empty. Throws UsageError if it makes no sense.
Shard chosenShard(const std::string& choice);

/// Throws UsageError if --resume has no --checkpoint, or a checkpoint is there that would be overwritten;
/// OutputError if the checkpoint cannot be written.
void checkLongRender(const LongRenderChoice& choice);

}  // namespace limpid::cli
