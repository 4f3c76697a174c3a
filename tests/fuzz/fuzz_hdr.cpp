#include "picture_target.h"
#include "scratch.h"

namespace limpid::fuzz {

bool hdr(Bytes input) {
    return readsAsRadiance(scratch().write("a.hdr", input));
}

}  // namespace limpid::fuzz
