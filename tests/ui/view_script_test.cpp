#include "app/view_script.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace lumi {
namespace {

std::string failure(const std::string& text) {
    try {
        parseViewScript(text, "tour.txt");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadInput);
        return error.what();
    }
    return "";
}

TEST(ViewScript, readsCommandsAndKeepsSpaces) {
    const auto lines =
        parseViewScript("# a tour\n\n  size 640 480\nclick layout:Side by side  \nwait-load\n", "tour.txt");
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0].command, "size");
    EXPECT_EQ(lines[0].arguments, (std::vector<std::string>{"640", "480"}));
    EXPECT_EQ(lines[0].where, "tour.txt:3");
    EXPECT_EQ(lines[1].rest, "layout:Side by side");
    EXPECT_TRUE(lines[2].arguments.empty());
}

TEST(ViewScript, namesLineAndNearestCommand) {
    const std::string text = failure("wait-load\nshoot a\n");
    EXPECT_NE(text.find("tour.txt:2"), std::string::npos) << text;
    EXPECT_NE(text.find("did you mean \"shot\""), std::string::npos) << text;
}

TEST(ViewScript, countsArguments) {
    EXPECT_NE(failure("size 640\n").find("wrong number of arguments"), std::string::npos);
    EXPECT_NE(failure("wait-load now\n").find("wrong number of arguments"), std::string::npos);
}

}  // namespace
}  // namespace lumi
