// Loops on all cores.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace limpid {

/// Calls use(i) for 0 to count - 1, on all cores if they are many.
template <typename Use>
void forEachIndex(size_t count, const Use& use) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 4096),
                      [&](const tbb::blocked_range<size_t>& range) {
                          for (size_t i = range.begin(); i < range.end(); ++i) use(i);
                      });
}

}  // namespace limpid
