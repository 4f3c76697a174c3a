// libFuzzer's entry point for one target, LIMPID_FUZZ_TARGET: a function of targets.h.
#include <signal.h>
#include <sys/time.h>
#include <tbb/global_control.h>

#include <cstdint>
#include <cstdlib>

#include "base/log.h"
#include "targets.h"

namespace {

/// Processor time, not wall-clock time: a fuzzer that is stopped or waits for other programs does not hang.
constexpr time_t secondsPerInput = 10;

void setTimer(time_t seconds) {
    itimerval timer{};
    timer.it_value.tv_sec = seconds;
    ::setitimer(ITIMER_PROF, &timer, nullptr);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    limpid::log::setLevel(limpid::log::Level::Error);
    // libFuzzer treats an abort as a finding and keeps the input.
    ::signal(SIGPROF, [](int) { std::abort(); });
    static const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    setTimer(secondsPerInput);
    limpid::fuzz::LIMPID_FUZZ_TARGET(std::as_bytes(std::span(data, size)));
    setTimer(0);
    return 0;
}
