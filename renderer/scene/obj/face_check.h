#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace lumi {

/// Follows an OBJ's lines: do the corners of its faces, "v/vt/vn" each, refer to what there is? Numbers from 1 may
/// refer to later lines, those below 0 count back from their own.
class FaceCheck {
public:
    /// A `v` (0), `vt` (1) or `vn` (2) line.
    void addElement(size_t kind) { ++kinds_[kind].count; }
    /// One word of an `f` line. Throws Error(BadInput), headed by the file and the line, if it has no vertex or counts
    /// back too far.
    void addCorner(std::string_view corner, const std::string& file, size_t line);
    /// At the file's end. Throws likewise for the largest number if there are fewer.
    void finish(const std::string& file) const;

private:
    struct Kind {
        const char* name;
        int64_t count = 0;
        int64_t largest = 0;  ///< that a face refers to
        size_t lineOfLargest = 0;
    };
    std::array<Kind, 3> kinds_{{{"vertex"}, {"texture coordinate"}, {"normal"}}};
};

}  // namespace lumi
