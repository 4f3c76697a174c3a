// Networks behind SVGF on the CPU.
#pragma once

#include "denoise/methods/nano/nano_host.h"

namespace limpid::denoise {

/// The one of this process. It keeps layers and memory of the last two sizes. Null if Limpid was built
/// without oneDNN.
NanoHost* networkHost();

}  // namespace limpid::denoise
