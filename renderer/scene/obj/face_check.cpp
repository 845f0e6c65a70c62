#include "scene/obj/face_check.h"

#include <charconv>

#include "base/error.h"

namespace lumi {
namespace {

[[noreturn]] void fail(const char* kind, const std::string& file, size_t line, const std::string& expected,
                       int64_t found) {
    throwBadInput({.what = std::string("a face refers to a ") + kind + " that does not exist",
                   .where = file + ":" + std::to_string(line),
                   .expected = expected,
                   .found = std::to_string(found)});
}

}  // namespace

void FaceCheck::addCorner(std::string_view corner, const std::string& file, size_t line) {
    for (Kind& kind : kinds_) {
        const std::string_view word = corner.substr(0, corner.find('/'));
        int64_t number = 0;  // stays so where none is written
        std::from_chars(word.data(), word.data() + word.size(), number);
        if (number == 0 && &kind == kinds_.data())
            throwBadInput({.what = "a face has a corner without a vertex",
                           .where = file + ":" + std::to_string(line),
                           .expected = "a number from 1, or below 0",
                           .found = std::string(corner.substr(0, 40))});
        if (number < -kind.count)
            fail(kind.name, file, line,
                 kind.count > 0 ? "-" + std::to_string(kind.count) + " to -1" : "none, since there are none before it",
                 number);
        if (number > kind.largest) kind.largest = number, kind.lineOfLargest = line;
        if (word.size() == corner.size()) return;
        corner.remove_prefix(word.size() + 1);
    }
}

void FaceCheck::finish(const std::string& file) const {
    for (const Kind& kind : kinds_)
        if (kind.largest > kind.count)
            fail(kind.name, file, kind.lineOfLargest,
                 kind.count > 0 ? "1 to " + std::to_string(kind.count) : "none, since there are none", kind.largest);
}

}  // namespace lumi
