#include "base/huge_pages.h"

#include <sys/mman.h>

#include <cstdint>

namespace lumi {
namespace {

constexpr int kCollapse = 25;  ///< MADV_COLLAPSE of Linux 6.1, at once and not some time; Debian 12's headers do not name it

}  // namespace

void gatherOnHugePages(const void* begin, size_t bytes) {
    constexpr uintptr_t kHugePage = uintptr_t(2) << 20;
    const auto first = (reinterpret_cast<uintptr_t>(begin) + kHugePage - 1) / kHugePage * kHugePage;
    const auto last = (reinterpret_cast<uintptr_t>(begin) + bytes) / kHugePage * kHugePage;
    if (last <= first) return;
    // Advice only: refused, the memory is as good.
    auto* const pages = reinterpret_cast<void*>(first);
    ::madvise(pages, last - first, MADV_HUGEPAGE);
    ::madvise(pages, last - first, kCollapse);
}

}  // namespace lumi
