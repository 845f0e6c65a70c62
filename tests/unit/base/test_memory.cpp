#include <gtest/gtest.h>

#include <vector>

#include "base/memory.h"
#include "support/expect_error.h"

namespace lumi {
namespace {
using test::expectError;

TEST(Memory, SizesAreWrittenAndRead) {
    EXPECT_EQ(formatBytes(0), "0 B");
    EXPECT_EQ(formatBytes(1023), "1023 B");
    EXPECT_EQ(formatBytes(640 * 1024), "640.0 KiB");
    EXPECT_EQ(formatBytes(uint64_t(3) << 29), "1.5 GiB");
    EXPECT_EQ(formatBytes(~uint64_t(0)), "16.0 EiB");
    EXPECT_EQ(parseBytes("512"), 512u);
    EXPECT_EQ(parseBytes("512B"), 512u);
    EXPECT_EQ(parseBytes("1.5K"), 1536u);
    EXPECT_EQ(parseBytes("512M"), uint64_t(512) << 20);
    EXPECT_EQ(parseBytes("2GiB"), uint64_t(2) << 30);
    EXPECT_NEAR(static_cast<double>(parseBytes("50%")) * 1.5, static_cast<double>(parseBytes("75%")), 100);
}

TEST(Memory, NonsenseIsNotASize) {
    for (const char* text : {"", "M", "-5M", "0", "nan", "inf", "5X", "5 M x", "1e30G"})
        expectError(ErrorKind::Usage, [&] { parseBytes(text); }, {"not a size"});
}

TEST(Memory, TheLimitRefusesByName) {
    const uint64_t limit = memoryLimit();
    EXPECT_GT(limit, uint64_t(256) << 20);
    setMemoryLimit(residentBytes() + (uint64_t(10) << 20));
    checkMemory("something small", 1000);
    expectError(ErrorKind::Resources, [] { checkMemory("the texture", uint64_t(1) << 30); },
                {"the texture", "1.0 GiB"});
    expectError(ErrorKind::Resources, [] { checkMemory("everything", ~uint64_t(0)); }, {"everything"});
    setMemoryLimit(1);
    expectError(ErrorKind::Resources, [] { checkMemory("a bit", 1); }, {"a bit"});
    setMemoryLimit(limit);
}

TEST(Memory, ManySmallRequestsPassTheLimitNeither) {
    const uint64_t limit = memoryLimit();
    constexpr uint64_t kRoom = uint64_t(48) << 20, kPiece = 40000;
    setMemoryLimit(residentBytes() + kRoom);
    std::vector<std::vector<char>> pieces;
    uint64_t taken = 0;
    const auto takeAll = [&] {
        for (; taken < 2 * kRoom; taken += kPiece) {
            checkMemory("a piece", kPiece);
            pieces.emplace_back(kPiece, char(1));
        }
    };
    expectError(ErrorKind::Resources, takeAll, {"a piece"});
    EXPECT_GT(taken, kRoom / 2);
    EXPECT_LT(taken, kRoom + kRoom / 8);
    setMemoryLimit(limit);
}

TEST(Memory, ResidentBytesGrowWithUse) {
    const uint64_t before = residentBytes();
    std::vector<char> block(64 << 20, 1);
    EXPECT_GT(residentBytes(), before + (32 << 20));
    EXPECT_GE(peakResidentBytes() + (4 << 20), residentBytes());
    EXPECT_EQ(block[5], 1);
}

}  // namespace
}  // namespace lumi
