// The network of `film`: that of `nano`, wider and deeper.
#pragma once

#include "denoise/methods/nano/nano_network.h"

namespace limpid::denoise {

const NanoNetwork& filmNetwork();

}  // namespace limpid::denoise
