// Memory that was freed, but that the C library keeps.
#pragma once

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace limpid {

/// Gives such memory back to the system, if the C library is glibc. After a driver has compiled shaders, that
/// can be a gigabyte.
inline void returnFreedMemory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace limpid
