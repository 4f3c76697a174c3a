// Networks behind SVGF on the CPU.
#pragma once

#include "denoise/methods/nano/nano_host.h"

namespace limpid::denoise {

/// The host of this process. Until it ends, it keeps the layers and the memory of the last sizes of tiles, of
/// about NanoHost::mostBytes in all. Null if Limpid was built without oneDNN.
NanoHost* networkHost();

}  // namespace limpid::denoise
