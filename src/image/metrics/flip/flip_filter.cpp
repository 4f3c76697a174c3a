#include <cstring>

#include "image/metrics/flip/flip_rows.h"

namespace limpid::image {
namespace {

#include "image/metrics/flip/flip_filter_impl.h"

}  // namespace

void flipFilter(const float* in, ptrdiff_t step, const FlipFilters& filters, size_t count) {
    filter(in, step, filters, count);
}

}  // namespace limpid::image
