#include "picture_target.h"
#include "scratch.h"

namespace limpid::fuzz {

bool exr(Bytes input) {
    return readsAsRadiance(scratch().write("a.exr", input));
}

}  // namespace limpid::fuzz
