#pragma once
#include <optional>
#include <string>

namespace lumi {

/// Keys by their place on a US keyboard. Printable ones have their ASCII code (upper case), so that '[' is a Key too.
enum class Key : int {
    None = 0,
    Space = ' ',
    Comma = ',',
    Period = '.',
    Slash = '/',
    LeftBracket = '[',
    RightBracket = ']',
    Minus = '-',
    Equal = '=',
    Digit0 = '0',
    Digit1 = '1',
    Digit9 = '9',
    A = 'A',
    B = 'B',
    C = 'C',
    D = 'D',
    E = 'E',
    F = 'F',
    G = 'G',
    H = 'H',
    I = 'I',
    K = 'K',
    L = 'L',
    M = 'M',
    N = 'N',
    O = 'O',
    Q = 'Q',
    R = 'R',
    S = 'S',
    U = 'U',
    V = 'V',
    W = 'W',
    X = 'X',
    Y = 'Y',
    Z = 'Z',
    Escape = 256,
    Enter,
    Tab,
    Backspace,
    Insert,
    Delete,
    Right,
    Left,
    Down,
    Up,
    PageUp,
    PageDown,
    Home,
    End,
    F1,
    F2,
    F3,
    F4,
    F5,
    F6,
    F7,
    F8,
    F9,
    F10,
    F11,
    F12,
    LeftShift,
    LeftControl,
    LeftAlt,
    LeftSuper,
    RightShift,
    RightControl,
    RightAlt,
    RightSuper,
    KeypadEnter,
    Count
};
static_assert(static_cast<int>(Key::Count) <= 512);

/// A key with the modifiers held.
struct KeyChord {
    Key key = Key::None;
    bool control = false, shift = false, alt = false;
    bool operator==(const KeyChord&) const = default;
};

/// "Ctrl+Shift+Z", "F12", "[", "Space".
std::string formatChord(const KeyChord& chord);
/// Reads the same text, in any case; empty for a key that does not exist.
std::optional<KeyChord> parseChord(const std::string& text);

}  // namespace lumi
