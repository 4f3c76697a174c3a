#include "cli/cluster/session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sched.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <thread>

#include "base/error.h"
#include "base/log.h"
#include "base/log_receiver.h"
#include "cli/cluster/local_share.h"
#include "cli/console/interrupt.h"
#include "cluster/launcher.h"

namespace limpid::cli {
namespace {

std::unique_ptr<cluster::Ranks>& joined() {
    static std::unique_ptr<cluster::Ranks> instance;
    return instance;
}

int coresAllowed() {
    cpu_set_t cores;
    CPU_ZERO(&cores);
    return ::sched_getaffinity(0, sizeof cores, &cores) == 0 ? CPU_COUNT(&cores) : 1;
}

void shareCores(const cluster::Place& place) {
    const int allowed = coresAllowed(), all = static_cast<int>(::sysconf(_SC_NPROCESSORS_ONLN));
    const int threads = threadsOfProcess(allowed, all, place.localSize);
    if (allowed < all && allowed < all / place.localSize) {
        log::warn(
            "the launcher lets each process use {} of {} cores, and {} share the machine: mpirun --bind-to "
            "none "
            "gives them all",
            allowed, all, place.localSize);
    }
    if (place.localSize == 1) return;
    static const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                           static_cast<size_t>(threads));
    ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0);
}

template <size_t N>
bool isOneOf(const std::array<const char*, N>& commands, const std::string& command) {
    return std::ranges::find(commands, command) != commands.end();
}

/// Throws UsageError for a command that several processes would each do as a whole, and write the same files.
void refuseForSeveral(const cluster::Launch& launch, const std::string& command) {
    constexpr std::array alone{"merge", "compare"};
    if (launch.size <= 1 || !isOneOf(alone, command)) return;  // 0: the launcher does not say
    throw UsageError(fmt::format(
        "limpid {} is for one process, and a launcher such as mpirun started several: set LIMPID_MPI=0 if "
        "each process is to work for itself",
        command));
}

void join(const cluster::Launch& launch) {
    const std::chrono::milliseconds patience = cluster::patienceOf(std::getenv("LIMPID_CLUSTER_TIMEOUT"));
    try {
        joined() = std::make_unique<cluster::Ranks>(cluster::startTransport(launch), patience);
    } catch (const Error&) {
        if (launch.size != 1) throw;
    }
}

}  // namespace

void joinCluster(const std::string& command, bool help) {
    constexpr std::array shared{"render", "denoise", "dataset", "bench quality"};
    const cluster::Launch launch = cluster::findLaunch([](const char* name) { return std::getenv(name); });
    if (!launch.launched) return;
    try {
        if (!help) refuseForSeveral(launch, command);
        if (isOneOf(shared, command)) join(launch);
    } catch (const Error& fault) {
        if (launch.rank == 0) throw;
        // Process 0 says it. mpirun ends all when the first one ends.
        std::this_thread::sleep_for(std::chrono::seconds(1));
        std::_Exit(static_cast<int>(fault.code()));
    }
    if (!ranks()) return;
    log::setReceiver([](MessageLevel level, const std::string& text) { ranks()->show(level, text); });
    endInterruptedLater();
    shareCores(ranks()->place());
}

cluster::Ranks* ranks() {
    return joined().get();
}

bool isFirstProcess() {
    return !ranks() || ranks()->isFirst();
}

void refuseInCluster(bool chosen, const std::string& text) {
    if (chosen && ranks() && ranks()->place().size > 1) throw UsageError(text);
}

int leaveCluster(int code) {
    if (!ranks()) return code;
    if (code != 0) {  // wrong usage, which all find alike and only process 0 has told
        if (ranks()->isFirst()) ranks()->abort(code);
        std::this_thread::sleep_for(std::chrono::seconds(30));
        return code;
    }
    if (!ranks()->end()) ranks()->abort(code);
    log::setReceiver({});  // it uses what ends now
    joined().reset();
    endIfInterrupted();
    return code;
}

int failInCluster(int code, const std::string& message) {
    if (ranks()) ranks()->fail(code, message);
    log::error("{}", message);
    return code;
}

std::string describePieces(const std::vector<uint64_t>& madeByRank, const std::string& unit) {
    if (!ranks()) return "";
    return fmt::format("{} processes made {} {}", madeByRank.size(), fmt::join(madeByRank, ", "), unit);
}

}  // namespace limpid::cli
