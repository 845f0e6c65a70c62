#include "base/huge_pages.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <vector>

#include "base/timer.h"

namespace lumi {
namespace {

/// MADV_COLLAPSE of Linux 6.1, at once and not some time; Debian 12's headers do not name it
constexpr int kCollapse = 25;
constexpr uintptr_t kHuge = uintptr_t(2) << 20;
/// Larger ranges are addresses that were reserved for later (sanitizers do, and drivers).
constexpr uintptr_t kReserved = uintptr_t(1) << 38;
/// Of a huge page that is worth gathering: a sixteenth more memory at most.
constexpr double kLeastUsed = 15.0 / 16;

struct Range {
    uintptr_t begin = 0, end = 0;
};

/// The whole huge pages in it.
Range wholePages(Range range) { return {(range.begin + kHuge - 1) / kHuge * kHuge, range.end / kHuge * kHuge}; }

/// Advice only: refused, the memory is as good.
bool gather(Range pages) {
    void* const begin = reinterpret_cast<void*>(pages.begin);
    const size_t bytes = pages.end - pages.begin;
    ::madvise(begin, bytes, MADV_HUGEPAGE);
    return ::madvise(begin, bytes, kCollapse) == 0;
}

/// Private memory that can be written and is of no file: the heap and what large allocations are given.
std::vector<Range> privateMemory() {
    std::vector<Range> ranges;
    std::FILE* file = std::fopen("/proc/self/maps", "r");
    if (!file) return ranges;
    char line[512];
    while (std::fgets(line, sizeof line, file)) {
        Range range;
        char access[8] = "", name[8] = "";
        uint64_t inode = 0;
        const int fields = std::sscanf(line, "%" SCNxPTR "-%" SCNxPTR " %4s %*s %*s %" SCNu64 " %7s", &range.begin,
                                       &range.end, access, &inode, name);
        const bool unnamed = fields == 4, heap = fields == 5 && std::strcmp(name, "[heap]") == 0;
        if ((!unnamed && !heap) || inode != 0 || std::strcmp(access, "rw-p") != 0) continue;
        range = wholePages(range);
        if (range.begin < range.end && range.end - range.begin < kReserved) ranges.push_back(range);
    }
    std::fclose(file);
    return ranges;
}

/// Is that huge page's memory in use? `pages` is scratch, a byte a small page.
bool isUsed(uintptr_t at, std::vector<unsigned char>& pages) {
    if (::mincore(reinterpret_cast<void*>(at), kHuge, pages.data()) != 0) return false;
    const auto used = std::count_if(pages.begin(), pages.end(), [](unsigned char page) { return (page & 1) != 0; });
    return static_cast<double>(used) >= kLeastUsed * static_cast<double>(pages.size());
}

}  // namespace

void gatherOnHugePages(const void* begin, size_t bytes) {
    const auto first = reinterpret_cast<uintptr_t>(begin);
    const Range pages = wholePages({first, first + bytes});
    if (pages.begin < pages.end) gather(pages);
}

size_t gatherAllOnHugePages(double seconds) {
    const Timer timer;
    std::vector<unsigned char> pages(kHuge / static_cast<size_t>(::sysconf(_SC_PAGESIZE)));
    size_t gathered = 0;
    for (const Range& range : privateMemory())
        for (uintptr_t at = range.begin; at < range.end; at += kHuge) {
            if (timer.elapsedMs() > 1000 * seconds) return gathered;
            if (isUsed(at, pages) && gather({at, at + kHuge})) gathered += kHuge;
        }
    return gathered;
}

}  // namespace lumi
