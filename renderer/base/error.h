#pragma once
#include <stdexcept>
#include <string>

namespace lumi {

/// What kind of failure an Error is; the value is the program's exit code (see README, "Exit codes").
enum class ErrorKind {
    CheckFailed = 1,
    Usage = 2,      ///< unknown scene, module, metric, parameter or option
    BadInput = 3,   ///< a file that cannot be read or does not hold what it should
    NoDisplay = 4,  ///< no window system and no OpenGL context
    Resources = 5,  ///< memory limit, disk full
    Interrupted = 130
};

/// A failure a user can act on. Its text is "where: what; expected ..., found ...", for example
/// `atrium.json:12:9: "levels" is out of range; expected 1 to 8, found 12`. It is one line, whatever its parts hold,
/// and of long parts the middle is left out.
/// Broken promises between our own functions are asserts, not Errors.
struct ErrorText {
    std::string what{};      ///< the fault in one clause
    std::string where{};     ///< file, file:line:column, or file + JSON path; may be empty
    std::string expected{};  ///< may be empty
    std::string found{};     ///< may be empty
};

class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, ErrorText text);

    ErrorKind kind() const { return kind_; }
    int exitCode() const { return static_cast<int>(kind_); }
    const ErrorText& text() const { return text_; }

private:
    Error(ErrorText&& text, ErrorKind kind);

    ErrorKind kind_;
    ErrorText text_;
};

/// Shorthands for the two kinds that most code throws.
[[noreturn]] void throwBadInput(ErrorText text);
[[noreturn]] void throwUsage(ErrorText text);

/// The entry of `candidates` nearest to `name` by edit distance, or empty if none is near (more than a third off).
/// Used by messages: `unknown module "svgv"; did you mean "svgf"?`
template <class Range>
std::string nearestName(const std::string& name, const Range& candidates);

int editDistance(const std::string& a, const std::string& b);

template <class Range>
std::string nearestName(const std::string& name, const Range& candidates) {
    std::string best;
    int bestDistance = static_cast<int>(name.size()) / 3 + 2;
    for (const auto& candidate : candidates) {
        const int distance = editDistance(name, std::string(candidate));
        if (distance < bestDistance) {
            bestDistance = distance;
            best = std::string(candidate);
        }
    }
    return best;
}

}  // namespace lumi
