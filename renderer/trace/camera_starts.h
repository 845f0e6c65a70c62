#pragma once
#include <vector>

#include "trace/tracer.h"

namespace lumi {

constexpr int kMostInStartRow = 64;

/// Camera paths of sample `sample` of the pixels from (left, top) to before (right, bottom), row by row, at most
/// kMostInStartRow in a row: what cameraStart() gives. `starts` is overwritten.
void makeStarts(const FrameSampling& sampling, Pixel leftTop, Pixel rightBottom, uint64_t sample,
                std::vector<PathStart>& starts);

}  // namespace lumi
