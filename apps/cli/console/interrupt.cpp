#include "cli/console/interrupt.h"

#include <time.h>

#include <array>
#include <csignal>
#include <utility>

#include "base/log.h"

namespace limpid::cli {
namespace {

constexpr std::array<int, 3> signals{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t received = 0;
std::array<struct sigaction, 3> actionsBefore{};
bool said = false, endsLater = false, ofCluster = false;

void (*volatile beforeEnd)() = nullptr;
timespec since;  ///< of the first signal

/// Some programs send a signal to a process and again to its group (timeout does), which is one to their
/// user.
constexpr double secondsOfOne = 0.5;

extern "C" void onSignal(int signal) {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    if (received == 0) {
        since = now;
        received = signal;
        return;
    }
    const double elapsed = static_cast<double>(now.tv_sec - since.tv_sec) +
                           1e-9 * static_cast<double>(now.tv_nsec - since.tv_nsec);
    if (elapsed < secondsOfOne) return;
    if (beforeEnd) beforeEnd();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

}  // namespace

InterruptGuard::InterruptGuard() {
    struct sigaction action {};
    action.sa_handler = onSignal;
    action.sa_flags = SA_RESTART;
    for (const int signal : signals) ::sigaddset(&action.sa_mask, signal);
    for (size_t i = 0; i < signals.size(); ++i) {
        ::sigaction(signals[i], &action, &actionsBefore[i]);
        // A process in the background ignores Ctrl-C, and should go on doing so.
        if (actionsBefore[i].sa_handler == SIG_IGN) ::sigaction(signals[i], &actionsBefore[i], nullptr);
    }
}

InterruptGuard::~InterruptGuard() {
    for (size_t i = 0; i < signals.size(); ++i) ::sigaction(signals[i], &actionsBefore[i], nullptr);
}

bool interrupted() {
    if (received == 0) return false;
    if (!said && ofCluster) {
        log::warn(
            "a process of the run has ended, or the run is to end: a render goes on from its last checkpoint "
            "with "
            "--checkpoint FILE --resume, and limpid denoise with --resume");
    } else if (!said) {
        log::warn("interrupted: what there is will be written; once more ends at once");
    }
    said = true;
    return true;
}

bool interruptedQuietly() {
    return received != 0;
}

void beforeInterruptedEnd(void (*action)()) {
    beforeEnd = action;
}

void endInterruptedLater() {
    endsLater = ofCluster = true;
}

void endIfInterrupted() {
    if (received == 0 || std::exchange(endsLater, false)) return;
    std::signal(received, SIG_DFL);
    std::raise(received);
}

}  // namespace limpid::cli
