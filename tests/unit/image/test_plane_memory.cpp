// The memory of images: on cache lines, spread over pages, as large as asked for.
#include "image/plane_memory.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <set>
#include <vector>

namespace lumi {
namespace {

constexpr size_t kLine = 64, kPage = 4096, kHugePage = size_t(2) << 20;

uintptr_t addressOf(const void* block) { return reinterpret_cast<uintptr_t>(block); }

}  // namespace

TEST(PlaneMemory, IsWholeAndBeginsOnACacheLine) {
    for (const size_t bytes : {size_t(0), size_t(1), kLine, kPage, size_t(65535), size_t(65536), kHugePage - 1,
                               kHugePage, 3 * kHugePage + 5}) {
        void* const block = allocatePlaneMemory(bytes);
        ASSERT_NE(block, nullptr);
        EXPECT_EQ(addressOf(block) % kLine, 0u) << bytes;
        std::memset(block, 0x5a, bytes);
        freePlaneMemory(block);
    }
    freePlaneMemory(nullptr);
}

TEST(PlaneMemory, LargeBlocksBeginAtOtherDistancesFromTheirPages) {
    std::vector<void*> blocks;
    std::set<uintptr_t> distances;
    for (int i = 0; i < 16; ++i) {
        blocks.push_back(allocatePlaneMemory(kHugePage));
        distances.insert(addressOf(blocks.back()) % kPage);
    }
    EXPECT_EQ(distances.size(), blocks.size());
    for (void* block : blocks) freePlaneMemory(block);
}

TEST(PlaneMemory, AbsurdSizesAreRefused) {
    EXPECT_THROW(allocatePlaneMemory(std::numeric_limits<size_t>::max()), std::bad_alloc);
}

}  // namespace lumi
