#include "scene/obj/face_check.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include "base/error.h"

namespace lumi {
namespace {

std::string_view textOf(std::span<const char> word) { return {word.data(), word.size()}; }

/// 0 where none is written, the largest or smallest there is for what lies beyond.
int64_t numberOf(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    int64_t number = 0;
    if (std::from_chars(word.data(), word.data() + word.size(), number).ec != std::errc::result_out_of_range)
        return number;
    return word[0] == '-' ? std::numeric_limits<int64_t>::min() : std::numeric_limits<int64_t>::max();
}

void write(std::span<char> place, std::string text) {
    text.resize(place.size(), ' ');
    std::copy(text.begin(), text.end(), place.begin());
}

}  // namespace

void FaceCheck::addCorner(std::span<char> corner, size_t line) {
    std::string_view rest = textOf(corner);
    std::array<std::string_view, 3> parts;
    bool isPlain = true;
    for (size_t k = 0; k < 3; ++k) {
        Kind& kind = kinds_[k];
        const std::string_view word = rest.substr(0, rest.find('/'));
        const int64_t number = numberOf(word);
        const bool isThere = number != 0 && number >= -kind.count;
        if (k == 0 && number == 0) failWithoutVertex("a face", rest, line);
        if (k == 0 && !isThere)
            failReference(
                kind, line,
                kind.count > 0 ? "-" + std::to_string(kind.count) + " to -1" : "none, since there are none before it",
                word);
        if (isThere) parts[k] = word;
        else if (!word.empty() && kind.lastLeftOut != line) {
            if (kind.leftOutLines++ == 0) kind.firstLeftOut = line;
            kind.lastLeftOut = line;
        }
        if (number > kind.largest) kind.largest = number, kind.wordOfLargest = word, kind.lineOfLargest = line;
        const bool isLast = word.size() == rest.size();
        isPlain &= isThere || (k == 1 && word.empty() && !isLast);
        if (isLast) break;
        rest.remove_prefix(word.size() + 1);
        if (k == 2)
            throwBadInput({.what = "a corner of a face has more than three numbers",
                           .where = place(line),
                           .expected = "a vertex, a texture coordinate and a normal",
                           .found = std::string(textOf(corner).substr(0, 40))});
    }
    if (isPlain) return;
    std::string plain(parts[0]);
    if (!parts[1].empty() || !parts[2].empty()) plain.append("/").append(parts[1]);
    if (!parts[2].empty()) plain.append("/").append(parts[2]);
    write(corner, plain);
}

void FaceCheck::keepVertex(std::span<char> corner, size_t line) const {
    const std::string_view text = textOf(corner), vertex = text.substr(0, text.find('/'));
    if (numberOf(vertex) == 0) failWithoutVertex("a line or a point", text, line);
    if (vertex.size() < text.size()) write(corner, std::string(vertex));
}

void FaceCheck::finish() const {
    for (const Kind& kind : kinds_) {
        if (kind.largest > kind.count)
            failReference(kind, kind.lineOfLargest,
                          kind.count > 0 ? "1 to " + std::to_string(kind.count) : "none, since there are none",
                          kind.wordOfLargest);
        if (kind.leftOutLines == 0) continue;
        const size_t more = kind.leftOutLines - 1;
        const std::string others = more == 0 ? "" : ", as on " + std::to_string(more) + " more lines";
        warnings_.warnWhole(place(kind.firstLeftOut) + ": a face refers to a " + kind.name +
                            " that does not exist; it is left out" + others);
    }
}

void FaceCheck::failWithoutVertex(const char* owner, std::string_view corner, size_t line) const {
    throwBadInput({.what = std::string(owner) + " has a corner without a vertex",
                   .where = place(line),
                   .expected = "a number from 1, or below 0",
                   .found = std::string(corner.substr(0, 40))});
}

void FaceCheck::failReference(const Kind& kind, size_t line, const std::string& expected,
                              std::string_view found) const {
    throwBadInput({.what = std::string("a face refers to a ") + kind.name + " that does not exist",
                   .where = place(line),
                   .expected = expected,
                   .found = std::string(found.substr(0, 40))});
}

}  // namespace lumi
