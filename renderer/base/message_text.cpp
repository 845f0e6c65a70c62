#include "base/message_text.h"

#include <algorithm>

namespace lumi {
namespace {

constexpr std::string_view kLeftOut = " ... ";

bool continuesCharacter(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }

/// Where a character begins, at `at` or before it, but no more than a character's length away.
size_t characterBegin(std::string_view text, size_t at) {
    size_t begin = at;
    while (begin > 0 && at - begin < 4 && begin < text.size() && continuesCharacter(text[begin])) --begin;
    return begin;
}

}  // namespace

std::string messageText(std::string_view text, size_t most) {
    std::string_view head = text, tail;
    if (text.size() > most) {
        const size_t tailSize = most / 4;
        head = text.substr(0, characterBegin(text, most - tailSize - kLeftOut.size()));
        tail = text.substr(characterBegin(text, text.size() - tailSize));
    }
    std::string line;
    line.reserve(std::min(text.size(), most) + 8);
    const auto add = [&](std::string_view part) {
        for (const char c : part) {
            if (c == '\n') line += "\\n";
            else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) line += ' ';
            else line += c;
        }
    };
    add(head);
    if (text.size() > most) line += kLeftOut, add(tail);
    return line;
}

}  // namespace lumi
