// Whether a launcher such as mpirun or srun started this process as one of several.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "cluster/transport.h"

namespace limpid::cluster {

struct Launch {
    bool launched = false;
    int rank = 0;
    int size = 0;  ///< 0: the launcher does not say
};

/// From the variables that Open MPI, MPICH, Intel MPI and Slurm (with PMI) set. LIMPID_MPI=0 says that there
/// is none. `variable` returns the value of an environment variable, or null.
Launch findLaunch(const std::function<const char*(const char*)>& variable);

/// How long a process may be silent, for Ranks: the value of LIMPID_CLUSTER_TIMEOUT, seconds, or ten minutes
/// if it is null or empty. Throws UsageError if it is no number from 2 to 1e9: processes that live tell it
/// every second.
std::chrono::milliseconds patienceOf(const char* timeout);

/// Loads the module limpid_mpi, from the folder of the program or where it is installed (../lib/limpid), and
/// starts it. Throws Error with what to install if it is absent, or if the processes do not find each other.
Transport& startTransport(const Launch& launch);

}  // namespace limpid::cluster
