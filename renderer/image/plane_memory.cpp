#include "image/plane_memory.h"

#include <sys/mman.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>

namespace lumi {
namespace {

constexpr size_t kLine = 64;  ///< bytes of a cache line
/// of the 4 KiB after which addresses compete for the same lines of the first-level cache
constexpr size_t kPageLines = 64;
/// lines from one block's start to the next's; without a factor in common with kPageLines
constexpr size_t kSpread = 25;
/// where the system has them; a filter steps through dozens of pages at once
constexpr size_t kHugePage = size_t(2) << 20;
constexpr size_t kLarge = 1 << 16;  ///< bytes from which on the general allocator gives pages

size_t roundedUp(size_t bytes, size_t unit) { return (bytes + unit - 1) / unit * unit; }

/// Distance of a block's start from what the general allocator gave, at least a line: the word before the start keeps
/// the latter's address.
size_t leadOf(size_t bytes) {
    static std::atomic<size_t> blocks{0};
    return bytes < kLarge ? kLine : kLine * (1 + blocks++ * kSpread % kPageLines);
}

}  // namespace

void* allocatePlaneMemory(size_t bytes) {
    if (bytes > std::numeric_limits<size_t>::max() / 2) throw std::bad_alloc();
    const size_t lead = leadOf(bytes), whole = roundedUp(lead + bytes, kLine), huge = whole / kHugePage * kHugePage;
    // Up to a huge page more than needed, never touched: blocks that come back fit the next, and stay on huge pages.
    void* const given = huge > 0 ? std::aligned_alloc(kHugePage, huge + kHugePage) : std::aligned_alloc(kLine, whole);
    if (!given) throw std::bad_alloc();
    if (huge > 0) ::madvise(given, huge, MADV_HUGEPAGE);  // advice: refused, the memory is as good
    char* const start = static_cast<char*>(given) + lead;
    reinterpret_cast<void**>(start)[-1] = given;
    return start;
}

void freePlaneMemory(void* block) noexcept {
    if (block) std::free(static_cast<void**>(block)[-1]);
}

}  // namespace lumi
