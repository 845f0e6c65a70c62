#pragma once
#include <cstdint>

namespace lumi {

/// Half-open.
struct FrameRange {
    int64_t begin = 0, end = 1;
};

/// When a line of progress is drawn: Auto, if standard error is a terminal.
enum class Progress { Auto, Always, Never };

}  // namespace lumi
