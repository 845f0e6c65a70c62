#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <vector>

#include "base/huge_pages.h"
#include "base/memory.h"

namespace lumi {
namespace {

// Whatever the system makes of it: what is there stays, whole pages or not.
TEST(HugePages, ContentsStay) {
    for (const size_t size : {size_t(0), size_t(1000), (size_t(2) << 20) - 1, (size_t(9) << 20) + 4321}) {
        std::vector<uint32_t> values(size / 4);
        for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<uint32_t>(i * 2654435761u);
        const uint32_t* const where = values.data();
        gatherOnHugePages(values.data(), values.size() * 4);
        EXPECT_EQ(values.data(), where);
        size_t wrong = 0;
        for (size_t i = 0; i < values.size(); ++i) wrong += values[i] != static_cast<uint32_t>(i * 2654435761u);
        EXPECT_EQ(wrong, 0u) << size;
    }
}

TEST(HugePages, GatheringKeepsWhatIsThere) {
    std::vector<uint32_t> numbers(size_t(6) << 20);
    std::iota(numbers.begin(), numbers.end(), 7u);
    const uint32_t* const place = numbers.data();
    gatherAllOnHugePages(10);
    EXPECT_EQ(numbers.data(), place);
    size_t wrong = 0;
    for (size_t i = 0; i < numbers.size(); ++i) wrong += numbers[i] != i + 7u;
    EXPECT_EQ(wrong, 0u);
}

TEST(HugePages, GatheringTakesLittleMemory) {
    // Reserved and mostly untouched: it is not to be filled.
    std::vector<char> used(size_t(32) << 20, 1);
    const auto reserved = std::make_unique_for_overwrite<char[]>(size_t(512) << 20);
    for (size_t i = 0; i < size_t(512) << 20; i += size_t(1) << 20) reserved[i] = 1;
    const uint64_t before = residentBytes();
    gatherAllOnHugePages(10);
    EXPECT_LT(residentBytes(), before + (uint64_t(32) << 20));
    EXPECT_EQ(used[used.size() - 1] + reserved[0], 2);
}

TEST(HugePages, WithoutTimeNothingIsGathered) {
    const std::vector<char> used(size_t(32) << 20, 1);
    EXPECT_EQ(gatherAllOnHugePages(-1), 0u);
}

}  // namespace
}  // namespace lumi
