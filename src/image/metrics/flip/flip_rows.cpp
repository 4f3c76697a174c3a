#include "image/metrics/flip/flip_rows.h"

#include <math.h>  // NOLINT: declares the C functions of which the compiler has vector versions

#include <numbers>

#include "image/filmic.h"

namespace limpid::image {
namespace {

#include "image/metrics/flip/flip_rows_impl.h"

constexpr FlipRows table = tableWith(flipFilter);

}  // namespace

#ifdef LIMPID_FLIP_AVX2
const FlipRows& flipRowsAvx2();
#endif

const FlipRows& flipRows() {
#ifdef LIMPID_FLIP_AVX2
    static const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (avx2) return flipRowsAvx2();
#endif
    return table;
}

}  // namespace limpid::image
