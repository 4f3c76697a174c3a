#include "denoise/methods/methods.h"

namespace limpid::denoise {

std::span<const Method> methods() {
#define LIMPID_ROW(method)         \
    Method{#method,                \
           method::help,           \
           method::groups,         \
           method::readsLayers,    \
           method::readsVariances, \
           method::oneChannel,     \
           method::keepsHistory,   \
           method::samples,        \
           method::record},
    static constexpr std::array all{LIMPID_METHODS(LIMPID_ROW)};
#undef LIMPID_ROW
    return all;
}

}  // namespace limpid::denoise
