#include "image/io/rows/memory_bound.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text/bytes_text.h"

namespace limpid::image {

void warnReduced(const std::filesystem::path& name, PictureSize from, PictureSize to, uint64_t maxMemory) {
    log::warn(
        "{}: scaled down from {}x{} to {}x{} pixels while it is read, to stay below {} of memory "
        "(--max-image-memory)",
        name.string(), from.width, from.height, to.width, to.height, bytesText(maxMemory));
}

uint32_t reductionFor(const std::filesystem::path& name, PictureSize size, const Fits& fits,
                      uint64_t maxMemory) {
    const uint32_t most = std::max(size.width, size.height);
    for (uint32_t reduction = 1; reduction <= most; ++reduction) {
        const PictureSize to = reduced(size, reduction);
        if (!fits(to)) continue;
        if (reduction > 1) warnReduced(name, size, to, maxMemory);
        return reduction;
    }
    throw InputError(name, fmt::format("is {}x{} pixels; decoding its rows takes more than {} of memory "
                                       "(--max-image-memory)",
                                       size.width, size.height, bytesText(maxMemory)));
}

void requireFits(const std::filesystem::path& name, PictureSize size, const Fits& fits, uint64_t maxMemory,
                 const char* why) {
    if (fits(size)) return;
    throw InputError(name, fmt::format("is {}x{} pixels, which take more than {} of memory "
                                       "(--max-image-memory); {}",
                                       size.width, size.height, bytesText(maxMemory), why));
}

}  // namespace limpid::image
