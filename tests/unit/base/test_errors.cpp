#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "base/isa.h"
#include "base/message_text.h"
#include "support/expect_error.h"

namespace lumi {
struct LevelKernels {
    int level;
};
LUMI_KERNELS(LevelKernels, level)
// What the build makes of a file of KERNELS: one definition for each level.
namespace baseline {
const LevelKernels& levelTable() {
    static const LevelKernels table{1};
    return table;
}
}  // namespace baseline
namespace v3 {
const LevelKernels& levelTable() {
    static const LevelKernels table{2};
    return table;
}
}  // namespace v3
namespace v4 {
const LevelKernels& levelTable() {
    static const LevelKernels table{3};
    return table;
}
}  // namespace v4

namespace {

TEST(Errors, TextSaysWhereWhatExpectedAndFound) {
    const Error full(ErrorKind::BadInput, {"\"levels\" is out of range", "atrium.json:12:9", "1 to 8", "12"});
    EXPECT_STREQ(full.what(), "atrium.json:12:9: \"levels\" is out of range; expected 1 to 8, found 12");
    EXPECT_STREQ(Error(ErrorKind::Usage, {"no such thing", "", "", "x"}).what(), "no such thing; found x");
    EXPECT_STREQ(Error(ErrorKind::Usage, {"no such thing", "", "y", ""}).what(), "no such thing; expected y");
    EXPECT_STREQ(Error(ErrorKind::Usage, {"no such thing", "", "", ""}).what(), "no such thing");
    EXPECT_EQ(full.text().expected, "1 to 8");
}

TEST(Errors, TextIsOneLineWhateverAFileHolds) {
    EXPECT_STREQ(Error(ErrorKind::BadInput, {"unknown key \"a\nb\tc\"", "", "", ""}).what(), "unknown key \"a\\nb c\"");
}

TEST(Errors, LongPartsLoseTheirMiddle) {
    const std::string name(100000, 'x');
    const Error error(ErrorKind::BadInput,
                      {"unknown key \"" + name + "\"", "a.json:1:2", "one of: a, b", name + "end"});
    const std::string text = error.what();
    EXPECT_LT(text.size(), 2100u);
    EXPECT_EQ(text.find("a.json:1:2: unknown key \"xxx"), 0u);
    EXPECT_NE(text.find("x ... x"), std::string::npos);
    EXPECT_NE(text.find("xxx\"; expected one of: a, b, found xxx"), std::string::npos);
    EXPECT_TRUE(text.ends_with("xxxend"));
    EXPECT_LE(error.text().found.size(), 1000u);
}

TEST(Errors, MessagesKeepCharactersWhole) {
    std::string umlauts;
    for (int i = 0; i < 5000; ++i) umlauts += "\u00fc";
    for (size_t most = 40; most < 60; ++most) {
        const std::string text = messageText(umlauts, most);
        EXPECT_LE(text.size(), most + 4);
        std::string without = text;
        for (size_t at = 0; (at = without.find("\u00fc")) != without.npos;) without.erase(at, 2);
        EXPECT_EQ(without, " ... ") << most;
    }
    EXPECT_EQ(messageText("a\x1b[31m\nb", 100), "a [31m\\nb");
    EXPECT_EQ(messageText(std::string(100, 'x'), 100), std::string(100, 'x'));
}

TEST(Errors, ExitCodesAreTheContract) {
    const std::pair<ErrorKind, int> codes[] = {{ErrorKind::CheckFailed, 1}, {ErrorKind::Usage, 2},
                                               {ErrorKind::BadInput, 3},    {ErrorKind::NoDisplay, 4},
                                               {ErrorKind::Resources, 5},   {ErrorKind::Interrupted, 130}};
    for (const auto& [kind, code] : codes) EXPECT_EQ(Error(kind, {"x", "", "", ""}).exitCode(), code);
    test::expectError(ErrorKind::BadInput, [] { throwBadInput({"x", "", "", ""}); });
    test::expectError(ErrorKind::Usage, [] { throwUsage({"x", "", "", ""}); });
}

TEST(Errors, EditDistance) {
    EXPECT_EQ(editDistance("kitten", "sitting"), 3);
    EXPECT_EQ(editDistance("", "abc"), 3);
    EXPECT_EQ(editDistance("abc", ""), 3);
    EXPECT_EQ(editDistance("same", "same"), 0);
}

TEST(Errors, NearestNameIsNearOrNothing) {
    const std::vector<const char*> names = {"svgf", "accumulate", "none"};
    EXPECT_EQ(nearestName("svgv", names), "svgf");
    EXPECT_EQ(nearestName("acumulate", names), "accumulate");
    EXPECT_EQ(nearestName("texture-space", names), "");
    EXPECT_EQ(nearestName("x", std::vector<std::string>{}), "");
}

TEST(Isa, NamesRoundTripAndUnknownOnesAreRefused) {
    for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4}) EXPECT_EQ(parseIsa(isaName(isa)), isa);
    test::expectError(ErrorKind::Usage, [] { parseIsa("sse9"); }, {"sse9", "baseline"});
}

TEST(Isa, SelectionFollowsTheActiveLevel) {
    const Isa best = detectIsa();
    for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4}) {
        if (isa > best) {
            test::expectError(ErrorKind::Usage, [&] { setIsa(isa); }, {isaName(isa)});
            continue;
        }
        setIsa(isa);
        EXPECT_EQ(activeIsa(), isa);
        EXPECT_EQ(levelKernels().level, static_cast<int>(isa) + 1);
    }
    setIsa(best);
}

}  // namespace
}  // namespace lumi
