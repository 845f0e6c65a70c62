#pragma once
#include "reference/reference.h"
#include "reference/reference_file.h"

namespace lumi {

/// The image of block sums that begin with sample 0, with what they tell of its noise.
Reference finishedReference(const ReferenceState& state);

}  // namespace lumi
