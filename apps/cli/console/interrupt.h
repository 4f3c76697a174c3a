// Ctrl-C: the first one asks a command to finish early and write what it has, the second one ends it at once.
#pragma once

namespace limpid::cli {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP sets interrupted(); the next one ends the process.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
};

/// True after the first signal. Says so on stderr the first time that it is.
bool interrupted();
/// The same, for commands that have nothing to write: says nothing.
bool interruptedQuietly();

/// What a second signal does before it ends the process; null: nothing. Only what is allowed in signal
/// handlers.
void beforeInterruptedEnd(void (*action)());

/// Ends the process by the signal that came, so that shells and scripts see it (exit status 130 for Ctrl-C).
/// Returns if none came. Call it when everything is written.
void endIfInterrupted();
/// From now on the first endIfInterrupted() returns: a process that others wait for comes to it again at its
/// end.
void endInterruptedLater();

}  // namespace limpid::cli
