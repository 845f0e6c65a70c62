#pragma once
#include <string>

#include "reference/reference.h"

namespace lumi {

/// Everything that determines the samples of a reference, as JSON text: the spec, the instruction set in use, and the
/// sources, compiler and Embree of this build.
std::string referenceKeyText(const ReferenceSpec& spec);

/// Where two such texts differ first, as `path.max-depth: 3 and 6`, for messages.
std::string keyDifference(const std::string& a, const std::string& b);

}  // namespace lumi
