#pragma once
#include "image/image.h"
#include "math/hash.h"

namespace lumi::test {

/// Numbers for made-up planes, the same on every machine.
class Random {
public:
    explicit Random(uint32_t seed) : seed_(seed) {}
    float between(float low, float high) { return low + (high - low) * unitFloat(hashCombine(seed_, ++count_)); }

private:
    uint32_t seed_, count_ = 0;
};

}  // namespace lumi::test
