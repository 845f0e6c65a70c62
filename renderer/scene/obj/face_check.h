#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scene/file_warnings.h"

namespace lumi {

/// Follows an OBJ's lines: do the corners of its faces, "v/vt/vn" each, refer to what there is? Numbers from 1 may
/// refer to later lines, those below 0 count back from their own.
class FaceCheck {
public:
    explicit FaceCheck(FileWarnings& warnings) : warnings_(warnings) {}

    /// A `v` (0), `vt` (1) or `vn` (2) line.
    void addElement(size_t kind) { ++kinds_[kind].count; }
    /// One word of an `f` line. Throws Error(BadInput), headed by the file and the line, if it has no vertex, counts
    /// back too far for one, or has a fourth part. Texture coordinates and normals that are empty, 0 or counted back
    /// too far are taken out of the word, whose end is blank then.
    void addCorner(std::span<char> corner, size_t line);
    /// One word of an `l` or `p` line. Throws likewise if it has no vertex; the rest of the word is blank then.
    void keepVertex(std::span<char> corner, size_t line) const;
    /// At the file's end. Throws likewise for the largest number if there are fewer; one warning for the texture
    /// coordinates that were taken out, unless they were empty, and one for the normals.
    void finish() const;

private:
    struct Kind {
        const char* name;
        int64_t count = 0;
        int64_t largest = 0;  ///< that a face refers to
        std::string wordOfLargest = {};
        size_t lineOfLargest = 0;
        size_t leftOutLines = 0, firstLeftOut = 0, lastLeftOut = 0;
    };
    std::string place(size_t line) const { return warnings_.file() + ":" + std::to_string(line); }
    [[noreturn]] void failWithoutVertex(const char* owner, std::string_view corner, size_t line) const;
    [[noreturn]] void failReference(const Kind& kind, size_t line, const std::string& expected,
                                    std::string_view found) const;

    FileWarnings& warnings_;
    std::array<Kind, 3> kinds_{{{"vertex"}, {"texture coordinate"}, {"normal"}}};
};

}  // namespace lumi
