// As flip_filter.cpp, compiled for AVX2 and fused multiply-add. A fused sum changes nothing on a constant.
#include "image/metrics/flip/flip_rows.h"

namespace limpid::image {
namespace {

#include "image/metrics/flip/flip_filter_impl.h"

}  // namespace

void flipFilterAvx2(const float* in, ptrdiff_t step, const FlipFilters& filters, size_t count) {
    filter(in, step, filters, count);
}

}  // namespace limpid::image
