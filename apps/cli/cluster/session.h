// A command that a launcher (mpirun, srun) started as several processes.
#pragma once

#include <string>
#include <vector>

#include "cluster/ranks.h"

namespace limpid::cli {

/// Joins the processes of the run if there are several, or one under a launcher that says so. `command`:
/// render, denoise, dataset or bench quality; merge and compare are refused (UsageError) if there are
/// several, except for `help`; other commands do their work in each process. Sets the number of threads of
/// this process, if it shares the machine with others: of TBB, and of lavapipe (LP_NUM_THREADS, unless it is
/// set already). Throws Error as cluster::startTransport() and patienceOf().
void joinCluster(const std::string& command, bool help);

/// The processes of this run; null if there is only this one.
cluster::Ranks* ranks();

/// True on the process that writes and reports.
bool isFirstProcess();

/// Throws UsageError if there are several processes, which cannot do this: "--shard: ...".
void refuseInCluster(bool chosen, const std::string& text);

/// The end of the run, with main()'s exit code: all processes that did what they should come here.
int leaveCluster(int code);
/// The end of a run that failed. Without a cluster: shows the message and returns `code`.
int failInCluster(int code, const std::string& message);

/// "8 processes made 12, 11, ... pieces", for humans; empty without a cluster.
std::string describePieces(const std::vector<uint64_t>& madeByRank, const std::string& unit);

}  // namespace limpid::cli
