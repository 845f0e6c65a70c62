#include "scene/obj/number_check.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include "base/error.h"
#include "scene/obj/face_check.h"
#include "scene/reach.h"

namespace lumi {
namespace {

constexpr std::string_view kSpace = " \t\r", kInitials = "vflp";

bool isNumeric(std::string_view kind) {
    return kind == "v" || kind == "vt" || kind == "vn" || kind == "f" || kind == "l" || kind == "p";
}

/// The next word of a line, which is shortened by it; empty at its end.
std::string_view nextWord(std::string_view& line) {
    const size_t begin = line.find_first_not_of(kSpace);
    if (begin == line.npos) return {};
    line.remove_prefix(begin);
    const std::string_view word = line.substr(0, line.find_first_of(kSpace));
    line.remove_prefix(word.size());
    return word;
}

bool isFiniteNumber(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
    // What is too small for a double is 0, and good.
    const bool fits = code == std::errc() || (code == std::errc::result_out_of_range &&
                                              word.find_first_of("eE") != word.npos && word.find("-", 1) != word.npos);
    return fits && end == word.data() + word.size() && std::isfinite(static_cast<float>(value));
}

/// The first three numbers of a line that are all finite: are they a place in reach? The first that is not, or nothing.
std::string_view farCoordinate(std::string_view line) {
    for (int c = 0; c < 3; ++c) {
        std::string_view word = nextWord(line);
        const std::string_view shown = word.substr(0, 40);
        if (word.starts_with('+')) word.remove_prefix(1);
        float value = 0;
        std::from_chars(word.data(), word.data() + word.size(), value);
        if (!isInReach(value)) return shown;
    }
    return {};
}

/// The first word that is no finite number, or what is missing among `least`; empty if all is well.
std::string_view faultOf(std::string_view line, int least) {
    int count = 0;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line), ++count)
        if (!isFiniteNumber(word)) return word.substr(0, 40);
    return count < least ? std::string_view("too few numbers") : std::string_view();
}

}  // namespace

void checkObjNumbers(std::string& text, FileWarnings& warnings) {
    const std::string& where = warnings.file();
    size_t lineNumber = 0, faults = 0, first = 0;
    FaceCheck faces(warnings);
    const auto inText = [&](std::string_view part) {
        return std::span(text).subspan(static_cast<size_t>(part.data() - text.data()), part.size());
    };
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find('\n', at), text.size());
        std::string_view line = std::string_view(text).substr(at, end - at);
        at = end + 1;
        ++lineNumber;
        const size_t begin = line.find_first_not_of(kSpace);
        if (begin == line.npos || kInitials.find(line[begin]) == kInitials.npos) continue;
        const std::string_view kind = nextWord(line);
        if (!isNumeric(kind)) continue;
        if (const size_t comment = line.find('#'); comment != line.npos) {
            std::ranges::fill(inText(line.substr(comment)), ' ');
            line = line.substr(0, comment);
        }
        if (kind == "f") {
            for (std::string_view corner = nextWord(line); !corner.empty(); corner = nextWord(line))
                faces.addCorner(inText(corner), lineNumber);
        } else if (kind == "l" || kind == "p") {
            // tinyobj refuses one without any corner.
            if (line.find_first_not_of(kSpace) == line.npos) std::ranges::fill(inText(kind), ' ');
            for (std::string_view corner = nextWord(line); !corner.empty(); corner = nextWord(line))
                faces.keepVertex(inText(corner), lineNumber);
        } else if (kind == "v") {
            faces.addElement(0);
            if (const std::string_view fault = faultOf(line, 3); !fault.empty())
                throwBadInput({.what = "the position of a vertex is no place",
                               .where = where + ":" + std::to_string(lineNumber),
                               .expected = "three finite numbers",
                               .found = std::string(fault)});
            if (const std::string_view far = farCoordinate(line); !far.empty())
                throwBadInput({.what = "the position of a vertex is out of range",
                               .where = where + ":" + std::to_string(lineNumber),
                               .expected = reachText(),
                               .found = std::string(far)});
        } else {
            if (line.empty()) continue;  // tinyobj looks for a space behind the word
            faces.addElement(kind == "vt" ? 1 : 2);
            if (faultOf(line, kind == "vt" ? 1 : 3).empty()) continue;
            if (faults++ == 0) first = lineNumber;
        }
    }
    faces.finish();
    if (faults > 0)
        warnings.warnWhole(where + ":" + std::to_string(first) + ": not finite numbers, read as 0" +
                           (faults > 1 ? ", as on " + std::to_string(faults - 1) + " more lines" : std::string()));
}

}  // namespace lumi
