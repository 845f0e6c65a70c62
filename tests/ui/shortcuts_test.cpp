#include "ui/shortcuts.h"

#include <gtest/gtest.h>

#include <set>

namespace lumi {
namespace {

TEST(Shortcuts, noKeyMeansTwoThings) {
    std::set<std::string> taken;
    for (const Shortcut& row : shortcuts())
        for (int i = 0; i < row.keys; ++i) {
            KeyChord chord = row.chord;
            chord.key = static_cast<Key>(static_cast<int>(chord.key) + i);
            EXPECT_TRUE(taken.insert(formatChord(chord)).second) << formatChord(chord) << ": " << row.text;
        }
}

TEST(Shortcuts, everyRowIsDispatchedAsItSays) {
    for (const Shortcut& row : shortcuts()) {
        const auto found = commandFor(row.chord);
        if (row.held) {
            EXPECT_FALSE(found) << row.text;
            continue;
        }
        ASSERT_TRUE(found) << row.text;
        EXPECT_EQ(found->command, row.command) << row.text;
        EXPECT_EQ(found->index, 0);
    }
}

TEST(Shortcuts, digitsCountTheBuffers) {
    const auto third = commandFor(*parseChord("3"));
    ASSERT_TRUE(third);
    EXPECT_EQ(third->command, UiCommand::ShowBuffer);
    EXPECT_EQ(third->index, 2);
    const auto store = commandFor(*parseChord("ctrl+9"));
    ASSERT_TRUE(store);
    EXPECT_EQ(store->command, UiCommand::StoreBookmark);
    EXPECT_EQ(store->index, 8);
}

TEST(Shortcuts, modifiersAreExact) {
    EXPECT_FALSE(commandFor(*parseChord("ctrl+shift+alt+z")));
    EXPECT_EQ(commandFor(*parseChord("ctrl+z"))->command, UiCommand::Undo);
    EXPECT_EQ(commandFor(*parseChord("ctrl+shift+z"))->command, UiCommand::Redo);
    EXPECT_EQ(commandFor(*parseChord("z"))->command, UiCommand::Loupe);
}

TEST(Keys, textGoesBothWays) {
    for (const char* text : {"F12", "Ctrl+Shift+Z", "[", "Space", "PgUp", "Alt+3", "Esc", "."}) {
        const auto chord = parseChord(text);
        ASSERT_TRUE(chord) << text;
        EXPECT_EQ(formatChord(*chord), text);
    }
    EXPECT_FALSE(parseChord("hyper+a"));
    EXPECT_FALSE(parseChord("F99"));
    EXPECT_FALSE(parseChord(""));
}

}  // namespace
}  // namespace lumi
