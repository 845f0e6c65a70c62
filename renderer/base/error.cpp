#include "base/error.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace lumi {
namespace {

/// Names and values come from files: whatever they hold, a message stays one line.
std::string oneLine(const std::string& text) {
    std::string line;
    for (const char c : text) {
        if (c == '\n') line += "\\n";
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) line += ' ';
        else line += c;
    }
    return line;
}

std::string sentence(const ErrorText& text) {
    std::string line;
    if (!text.where.empty()) line += text.where + ": ";
    line += text.what;
    if (!text.expected.empty()) line += "; expected " + text.expected;
    if (!text.found.empty()) line += (text.expected.empty() ? "; found " : ", found ") + text.found;
    return line;
}

}  // namespace

Error::Error(ErrorKind kind, ErrorText text)
    : std::runtime_error(oneLine(sentence(text))), kind_(kind), text_(std::move(text)) {}

void throwBadInput(ErrorText text) { throw Error(ErrorKind::BadInput, std::move(text)); }
void throwUsage(ErrorText text) { throw Error(ErrorKind::Usage, std::move(text)); }

int editDistance(const std::string& a, const std::string& b) {
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (size_t i = 1; i <= a.size(); ++i) {
        int diagonal = row[0];
        row[0] = static_cast<int>(i);
        for (size_t j = 1; j <= b.size(); ++j) {
            const int substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
        }
    }
    return row[b.size()];
}

}  // namespace lumi
