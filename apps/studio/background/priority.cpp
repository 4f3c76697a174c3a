#include "studio/background/priority.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

namespace limpid::studio {
namespace {

// Of 0 (usual) to 19 (last).
constexpr int frames = 10, belowFrames = 15;

void lowerPriorityTo(int wanted) {
    // On Linux, each thread has a priority of its own.
    const auto thread = static_cast<id_t>(::syscall(SYS_gettid));
    errno = 0;
    const int now = ::getpriority(PRIO_PROCESS, thread);
    if (errno == 0 && now < wanted) (void)::setpriority(PRIO_PROCESS, thread, wanted);
}

}  // namespace

void lowerPriority() {
    lowerPriorityTo(frames);
}

void lowerPriorityBelowFrames() {
    lowerPriorityTo(belowFrames);
}

}  // namespace limpid::studio
