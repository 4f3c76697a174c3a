// Like flip_filter.cpp, compiled for AVX2 with fused multiply-add. On a constant input the result is still
// exact.
#include <cstring>

#include "image/metrics/flip/flip_rows.h"

namespace limpid::image {
namespace {

#include "image/metrics/flip/flip_filter_impl.h"

}  // namespace

void flipFilterAvx2(const float* in, ptrdiff_t step, const FlipFilters& filters, size_t count) {
    filter(in, step, filters, count);
}

}  // namespace limpid::image
