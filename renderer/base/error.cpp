#include "base/error.h"

#include "base/message_text.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace lumi {
namespace {

ErrorText shown(ErrorText text) {
    for (std::string* part : {&text.what, &text.where, &text.expected, &text.found})
        *part = messageText(*part, kMostOfErrorPart);
    return text;
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

Error::Error(ErrorKind kind, ErrorText text) : Error(shown(std::move(text)), kind) {}

Error::Error(ErrorText&& text, ErrorKind kind)
    : std::runtime_error(sentence(text)), kind_(kind), text_(std::move(text)) {}

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
