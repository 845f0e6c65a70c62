#include <gtest/gtest.h>

#include <thread>

#include "base/files.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lumi {
namespace {
namespace fs = std::filesystem;
using test::expectError;
using test::TemporaryFolder;

TEST(Files, RoundTripWithEveryByte) {
    const TemporaryFolder folder;
    std::vector<uint8_t> bytes;
    for (int i = 0; i < 1000; ++i) bytes.push_back(static_cast<uint8_t>(i));
    writeFileAtomically(folder / "a/b/c.bin", bytes);
    EXPECT_EQ(readFile(folder / "a/b/c.bin"), bytes);
    writeFileAtomically(folder / "empty", std::string_view());
    EXPECT_TRUE(readFile(folder / "empty").empty());
    writeFileAtomically(folder / "a/b/c.bin", std::string_view("new"));
    EXPECT_EQ(readTextFile(folder / "a/b/c.bin"), "new");
}

TEST(Files, WritingLeavesNothingElseBehind) {
    const TemporaryFolder folder;
    writeFileAtomically(folder / "a.txt", "hello");
    fs::create_directories(folder / "taken");
    fs::create_directories(folder / "taken/inside");
    expectError(ErrorKind::Usage, [&] { writeFileAtomically(folder / "taken", "x"); }, {"taken"});
    int entries = 0;
    for (const auto& entry : fs::directory_iterator(folder.path())) entries += entry.exists() ? 1 : 0;
    EXPECT_EQ(entries, 2);
}

TEST(Files, WritersOfOneFileDoNotMix) {
    const TemporaryFolder folder;
    const std::string a(200000, 'a'), b(300000, 'b');
    const auto write = [&](const std::string& text) {
        for (int round = 0; round < 20; ++round) writeFileAtomically(folder / "shared.txt", text);
    };
    std::thread first(write, a), second(write, b);
    first.join(), second.join();
    const std::string left = readTextFile(folder / "shared.txt");
    EXPECT_TRUE(left == a || left == b);
}

TEST(Files, UnreadableThingsAreNamed) {
    const TemporaryFolder folder;
    expectError(ErrorKind::BadInput, [&] { readFile(folder / "missing"); }, {"missing", "no such file"});
    expectError(ErrorKind::BadInput, [&] { readFile(folder.path()); }, {"directory"});
    expectError(ErrorKind::BadInput, [] { readFile("/dev/zero"); }, {"/dev/zero", "regular"});
    writeFileAtomically(folder / "big", std::string(100, 'x'));
    expectError(ErrorKind::BadInput, [&] { readFile(folder / "big", 99); }, {"99 bytes", "100 bytes"});
    EXPECT_EQ(readFile(folder / "big", 100).size(), 100u);
    expectError(ErrorKind::Usage, [] { writeFileAtomically("/proc/nothing/here", "x"); }, {"/proc/nothing/here"});
}

TEST(Files, UnfinishedOnesAreKnownByTheirNames) {
    const auto part = unfinishedFile("out/a.b.png.4711.12.tmp");
    ASSERT_TRUE(part);
    EXPECT_EQ(part->whole, "out/a.b.png");
    EXPECT_EQ(part->process, 4711);
    for (const char* name : {"a.png", "a.tmp", "a.png.12.tmp", "a.png.x.12.tmp", "a.png.12.y.tmp", "a.png.-1.12.tmp",
                             ".1.2.tmp", "a.png.99999999999.1.tmp", "a.png.1.2.TMP", "out/1.2.tmp", ""})
        EXPECT_FALSE(unfinishedFile(name)) << name;
}

TEST(Files, UnusedPathsCount) {
    const TemporaryFolder folder;
    EXPECT_EQ(unusedPath(folder / "shot.png"), folder / "shot.png");
    writeFileAtomically(folder / "shot.png", "");
    EXPECT_EQ(unusedPath(folder / "shot.png"), folder / "shot-1.png");
    writeFileAtomically(folder / "shot-1.png", "");
    EXPECT_EQ(unusedPath(folder / "shot.png"), folder / "shot-2.png");
}

TEST(Files, NewFilesTakeNoOthersName) {
    const TemporaryFolder folder;
    const auto write = [&](const std::string& text) {
        for (int round = 0; round < 20; ++round)
            writeNewFile(folder / "shot.png", {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    };
    std::thread first(write, "a"), second(write, "b");
    first.join(), second.join();
    int as = 0, bs = 0;
    for (const auto& entry : fs::directory_iterator(folder.path())) (readTextFile(entry.path()) == "a" ? as : bs) += 1;
    EXPECT_EQ(as, 20);
    EXPECT_EQ(bs, 20);
    EXPECT_TRUE(fs::exists(folder / "shot.png"));
    EXPECT_TRUE(fs::exists(folder / "shot-39.png"));
}

// File systems take names of 255 bytes, of which the temporary file must not need more.
TEST(Files, LongNamesAreWritten) {
    const TemporaryFolder folder;
    const std::string longest(255, 'n');
    requireWritable(folder / longest);
    writeFileAtomically(folder / longest, "x");
    EXPECT_EQ(readTextFile(folder / longest), "x");
    expectError(ErrorKind::Usage, [&] { requireWritable(folder / (longest + "n")); }, {"too long"});
    expectError(ErrorKind::Usage, [&] { writeFileAtomically(folder / (longest + "n"), "x"); }, {"too long"});
    EXPECT_NO_THROW(unusedPath(folder / (longest + "n")));
    int entries = 0;
    for (const auto& entry : fs::directory_iterator(folder.path())) entries += entry.exists() ? 1 : 0;
    EXPECT_EQ(entries, 1);
}

TEST(Files, WhatCannotBeWrittenIsKnownBefore) {
    const TemporaryFolder folder;
    requireWritable(folder / "a/b/c.exr");
    EXPECT_TRUE(fs::is_empty(folder / "a/b")) << "the folder is there, and nothing in it";
    writeFileAtomically(folder / "file", "x");
    expectError(ErrorKind::Usage, [&] { requireWritable(folder / "file/x.exr"); },
                {"file/x.exr", "folder cannot be created", "Not a directory"});
    expectError(ErrorKind::Usage, [] { requireWritable("/proc/nothing/x.exr"); },
                {"/proc/nothing/x.exr", "folder cannot be created"});
}

TEST(Files, NamesInAFileStayInItsFolder) {
    EXPECT_EQ(pathInside("/models", "a/b.png"), fs::path("/models/a/b.png"));
    EXPECT_EQ(pathInside("/models", "a/../b.png"), fs::path("/models/b.png"));
    EXPECT_EQ(pathInside("/models", "..b/.../c"), fs::path("/models/..b/.../c"));
    EXPECT_EQ(pathInside("", "./b.png"), fs::path("b.png"));
    using namespace std::string_literals;
    for (const std::string& name :
         {"../b.png"s, "/b.png"s, "a/../../b.png"s, "a/./../..//b.png"s, ".."s, "a\0b"s, "//b"s})
        EXPECT_FALSE(pathInside("/models", name)) << name;
}

TEST(Files, ExtensionsAndDigests) {
    EXPECT_EQ(lowerExtension("A.B.ExR"), ".exr");
    EXPECT_EQ(lowerExtension("none"), "");
    // XXH3 of nothing, seed 0.
    EXPECT_EQ(digest({}), "2d06800538d394c2");
    const std::vector<uint8_t> a = {1, 2, 3}, b = {1, 2, 4};
    EXPECT_NE(digest64(a), digest64(b));
    EXPECT_NE(digest64(a, 1), digest64(a, 2));
    EXPECT_EQ(digest(a).size(), 16u);
}

}  // namespace
}  // namespace lumi
