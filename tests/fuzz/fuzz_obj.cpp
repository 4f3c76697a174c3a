#include "scratch.h"

namespace limpid::fuzz {

bool obj(Bytes input) {
    const Parts parts = splitAtZero(input);
    if (parts.split) {
        scratch().write("scene.mtl", parts.second);
    } else {
        scratch().remove("scene.mtl");
    }
    return reachesDevice(scratch().write("scene.obj", parts.first));
}

}  // namespace limpid::fuzz
