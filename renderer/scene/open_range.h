#pragma once
#include <algorithm>

#include "params/parameter.h"

namespace lumi {

/// Declares a number whose range is open above: the declared maximum shows, and stands for, infinity.
inline void describeUpTo(ParameterVisitor& visitor, const char* id, float& value, const NumberSpec& spec) {
    const float most = static_cast<float>(spec.max);
    const float before = std::min(value, most);
    float shown = before;
    visitor.number(id, shown, spec);
    if (shown != before) value = shown >= most ? kInfinity : shown;
}

}  // namespace lumi
