// Like flip_rows.cpp, compiled for AVX2.
#include <math.h>  // NOLINT: declares the C functions of which the compiler has vector versions

#include <numbers>

#include "image/filmic.h"
#include "image/metrics/flip/flip_rows.h"

namespace limpid::image {
namespace {

#include "image/metrics/flip/flip_rows_impl.h"

constexpr FlipRows table = tableWith(flipFilterAvx2);

}  // namespace

const FlipRows& flipRowsAvx2();
const FlipRows& flipRowsAvx2() {
    return table;
}

}  // namespace limpid::image
