#pragma once
#include <cstdint>

namespace lumi {

/// Least pixels for which it pays to read neighbours in a row rather than one by one.
constexpr int kLeastRun = 32;

/// Cuts [begin, end) into stretches and calls body(from, to, inARow) for each: inARow where follows(k) holds for all k
/// of (from, to), which says that what pixel k reads from memory lies one behind what pixel k - 1 reads. Motion of
/// smooth surfaces gives long stretches.
template <class Follows, class Body>
inline void forIndexRuns(int begin, int end, Follows follows, Body body) {
    int loose = begin;  // start of what is read one by one
    for (int from = begin; from < end;) {
        int to = from + 1;
        while (to < end && follows(to)) ++to;
        if (to - from >= kLeastRun) {
            if (loose < from) body(loose, from, false);
            body(from, to, true);
            loose = to;
        }
        from = to;
    }
    if (loose < end) body(loose, end, false);
}

}  // namespace lumi
