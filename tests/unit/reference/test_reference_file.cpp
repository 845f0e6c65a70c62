// The file of block sums: what goes in comes out; what is damaged is named.
#include <gtest/gtest.h>

#include "base/files.h"
#include "reference/reference_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lumi {
namespace {

ReferenceState someState() {
    const Extent2 extent{6, 4};
    ReferenceState state;
    state.key = R"({"seed":1})";
    state.extent = extent;
    for (uint64_t k = 0; k < 7; ++k) {
        SampleBlock leaf = SampleBlock::shaped({k * kLeafSamples, (k + 1) * kLeafSamples}, extent);
        for (size_t i = 0; i < leaf.sum.size(); ++i) leaf.sum.data()[i] = static_cast<double>(k * 100 + i) / 7;
        state.blocks.add(std::move(leaf));
    }
    state.tail = ImageOf<double>(extent, 3);
    state.tail.fill(0.1);
    state.tailCount = 3;
    state.depth = Image(extent, 1);
    state.depth.fill(2.5f);
    state.ladder = {{256, 0.123456789}, {320, 0.1}};
    state.goal = true;
    state.note = "anything \"at all\"\n";
    return state;
}

TEST(ReferenceFile, RoundTrip) {
    const test::TemporaryFolder folder;
    const ReferenceState state = someState();
    writeReferenceFile(folder / "deep/a.lumiref", state);
    const ReferenceState back = readReferenceFile(folder / "deep/a.lumiref");
    EXPECT_EQ(back.key, state.key);
    EXPECT_EQ(back.extent, state.extent);
    EXPECT_EQ(back.tail, state.tail);
    EXPECT_EQ(back.tailCount, 3u);
    EXPECT_EQ(back.depth, state.depth);
    EXPECT_EQ(back.ladder, state.ladder);
    EXPECT_EQ(back.note, state.note);
    EXPECT_TRUE(back.goal);
    EXPECT_EQ(back.samples(), 7 * 16 + 3u);
    ASSERT_EQ(back.blocks.blocks().size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(back.blocks.blocks()[i].sum, state.blocks.blocks()[i].sum);
        EXPECT_EQ(back.blocks.blocks()[i].left, state.blocks.blocks()[i].left);
        EXPECT_EQ(back.blocks.blocks()[i].scatter, state.blocks.blocks()[i].scatter);
    }
    SampleRange range;
    EXPECT_EQ(readReferenceHead(folder / "deep/a.lumiref", &range).key, state.key);
    EXPECT_EQ(range, (SampleRange{0, 112}));
    for (const auto& entry : std::filesystem::directory_iterator(folder / "deep"))
        EXPECT_EQ(entry.path().extension(), ".lumiref");
}

TEST(ReferenceFile, EveryChangedByteIsFound) {
    const test::TemporaryFolder folder;
    const auto path = folder / "a.lumiref";
    writeReferenceFile(path, someState());
    const std::vector<uint8_t> good = readFile(path);
    for (size_t i = 0; i < good.size(); i += i < 600 ? 1 : 37) {
        std::vector<uint8_t> bad = good;
        bad[i] ^= 0x10;
        writeFileAtomically(path, bad);
        test::expectError(ErrorKind::BadInput, [&] { readReferenceFile(path); }, {"a.lumiref"});
    }
    for (size_t length = 0; length < good.size(); length += length < 64 ? 1 : 211) {
        writeFileAtomically(path, std::span(good).first(length));
        test::expectError(ErrorKind::BadInput, [&] { readReferenceFile(path); }, {"a.lumiref"});
    }
    std::vector<uint8_t> longer = good;
    longer.push_back(0);
    writeFileAtomically(path, longer);
    test::expectError(ErrorKind::BadInput, [&] { readReferenceFile(path); }, {"length"});
    test::expectError(ErrorKind::BadInput, [&] { readReferenceFile(folder / "none.lumiref"); }, {"none.lumiref"});
    test::expectError(ErrorKind::BadInput, [&] { readReferenceFile(folder.path()); });
}

TEST(ReferenceFile, WhatCannotBeWrittenLeavesNothing) {
    const test::TemporaryFolder folder;
    writeFileAtomically(folder / "file", std::string_view("text"));
    test::expectError(ErrorKind::Usage, [&] { writeReferenceFile(folder / "file/a.lumiref", someState()); },
                      {"a.lumiref"});
}

}  // namespace
}  // namespace lumi
