#include "studio/state/state.h"

namespace limpid::studio {

int jitterChoice(Jitter jitter, const Pipeline& pipeline) {
    return jitter == defaultJitter(pipeline) ? 0 : 1 + static_cast<int>(jitter);
}

}  // namespace limpid::studio
