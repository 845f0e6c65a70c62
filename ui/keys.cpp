#include "ui/keys.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace lumi {

namespace {

struct NamedKey {
    Key key;
    const char* name;
};
constexpr std::array kNamedKeys{
    NamedKey{Key::Space, "Space"},
    NamedKey{Key::Escape, "Esc"},
    NamedKey{Key::Enter, "Enter"},
    NamedKey{Key::Tab, "Tab"},
    NamedKey{Key::Backspace, "Backspace"},
    NamedKey{Key::Insert, "Insert"},
    NamedKey{Key::Delete, "Delete"},
    NamedKey{Key::Right, "Right"},
    NamedKey{Key::Left, "Left"},
    NamedKey{Key::Down, "Down"},
    NamedKey{Key::Up, "Up"},
    NamedKey{Key::PageUp, "PgUp"},
    NamedKey{Key::PageDown, "PgDn"},
    NamedKey{Key::Home, "Home"},
    NamedKey{Key::End, "End"},
    NamedKey{Key::LeftShift, "Shift"},
    NamedKey{Key::LeftControl, "Ctrl"},
    NamedKey{Key::LeftAlt, "Alt"},
};

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

std::string keyName(Key key) {
    for (const NamedKey& named : kNamedKeys)
        if (named.key == key) return named.name;
    if (key >= Key::F1 && key <= Key::F12)
        return "F" + std::to_string(static_cast<int>(key) - static_cast<int>(Key::F1) + 1);
    return {static_cast<char>(key)};
}

Key keyByName(const std::string& name) {
    for (const NamedKey& named : kNamedKeys)
        if (lower(named.name) == name) return named.key;
    if (name.size() == 1 && std::isgraph(static_cast<unsigned char>(name[0])))
        return static_cast<Key>(std::toupper(static_cast<unsigned char>(name[0])));
    for (int number = 1; number <= 12; ++number)
        if (name == "f" + std::to_string(number)) return static_cast<Key>(static_cast<int>(Key::F1) + number - 1);
    return Key::None;
}

}  // namespace

std::string formatChord(const KeyChord& chord) {
    std::string text;
    if (chord.control) text += "Ctrl+";
    if (chord.alt) text += "Alt+";
    if (chord.shift) text += "Shift+";
    return text + keyName(chord.key);
}

std::optional<KeyChord> parseChord(const std::string& text) {
    KeyChord chord;
    std::string rest = lower(text);
    for (size_t plus = rest.find('+'); plus != std::string::npos && plus + 1 < rest.size(); plus = rest.find('+')) {
        const std::string modifier = rest.substr(0, plus);
        if (modifier == "ctrl") chord.control = true;
        else if (modifier == "shift") chord.shift = true;
        else if (modifier == "alt") chord.alt = true;
        else return std::nullopt;
        rest.erase(0, plus + 1);
    }
    chord.key = keyByName(rest);
    if (chord.key == Key::None) return std::nullopt;
    return chord;
}

}  // namespace lumi
