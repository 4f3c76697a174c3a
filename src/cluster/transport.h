// What the module limpid_mpi does: messages between the processes of a run. It is a module of its own, loaded
// by cluster/launcher.h, so that the programs need no MPI.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace limpid::cluster {

/// Which of the run's processes this is.
struct Place {
    int rank = 0, size = 1;
    int localRank = 0, localSize = 1;  ///< among the processes on this machine
};

class Transport {
  public:
    Transport() = default;
    Transport(const Transport&) = delete;
    Transport& operator=(const Transport&) = delete;
    virtual ~Transport() = default;

    virtual Place place() const = 0;
    /// Returns when `bytes` may be changed. Messages from one process to another arrive in order, but short
    /// ones may overtake long ones. From any thread.
    virtual void send(int to, std::span<const std::byte> bytes) = 0;
    /// If a whole message has arrived, fills in its sender and content. Does not wait. From one thread only.
    virtual bool poll(int& from, std::vector<std::byte>& bytes) = 0;
    /// A message of this process that has begun to arrive is not waited for any more.
    virtual void forget(int from) = 0;
    /// The orderly end, which all processes must come to. No call may follow.
    virtual void end() = 0;
    /// Ends all processes at once, with this exit code where the launcher passes it on.
    [[noreturn]] virtual void abort(int code) = 0;
};

/// Of the module: the function limpid_transport(), which starts MPI. Null, with a reason in `fault`, if it
/// cannot. `version` must be Limpid's own: the interface is one of C++, and promises nothing to other
/// versions.
using StartTransport = Transport* (*)(const char* version, const char** fault);

}  // namespace limpid::cluster
