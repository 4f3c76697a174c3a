// Large blocks of memory in pages of 2 MiB, as far as the system has some.
//
// Scenes of millions of triangles are built in arrays of gigabytes. Where Linux gives such pages only to
// those who ask (/sys/kernel/mm/transparent_hugepage/enabled: madvise), half of the time of loading went into
// the pages of 4 KiB.
#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <new>

// AddressSanitizer has operators of its own.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define LIMPID_OTHER_OPERATORS
#endif
#endif
#if defined(MADV_HUGEPAGE) && !defined(__SANITIZE_ADDRESS__) && !defined(LIMPID_OTHER_OPERATORS)

namespace limpid::cli {
namespace {

constexpr std::size_t largePage = std::size_t{1} << 21;
constexpr std::size_t largeBlock = 2 * largePage;

void* allocateBlock(std::size_t size) {
    if (size < largeBlock) return std::malloc(size > 0 ? size : 1);
    if (size > SIZE_MAX - largePage) return nullptr;
    const std::size_t rounded = (size + largePage - 1) / largePage * largePage;
    void* const block = std::aligned_alloc(largePage, rounded);
    // Not the last part of a page, which may be small. Without such pages it is slower, but works.
    if (block) madvise(block, size / largePage * largePage, MADV_HUGEPAGE);
    return block;
}

}  // namespace
}  // namespace limpid::cli

void* operator new(std::size_t size) {
    if (void* const block = limpid::cli::allocateBlock(size)) return block;
    throw std::bad_alloc();
}

void operator delete(void* block) noexcept {
    std::free(block);
}

void operator delete(void* block, std::size_t) noexcept {
    std::free(block);
}

#endif
