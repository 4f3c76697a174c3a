#include "studio/loop/priority.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

namespace limpid::studio {
namespace {

constexpr int background = 10;  ///< of 0 (usual) to 19 (last)

}  // namespace

void lowerPriority() {
    // On Linux, each thread has a priority of its own.
    const auto thread = static_cast<id_t>(::syscall(SYS_gettid));
    errno = 0;
    const int now = ::getpriority(PRIO_PROCESS, thread);
    if (errno == 0 && now < background) (void)::setpriority(PRIO_PROCESS, thread, background);
}

}  // namespace limpid::studio
