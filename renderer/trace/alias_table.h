#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vector.h"

namespace lumi {

/// Draws indices in proportion to weights in constant time [Vose 1991].
class AliasTable {
public:
    AliasTable() = default;
    /// Weights that are negative or not finite count as 0. If none is positive the table is empty.
    explicit AliasTable(std::span<const float> weights);

    bool empty() const { return bins_.empty(); }
    size_t size() const { return bins_.size(); }
    /// The index for u in [0, 1)^2: the first number chooses a bin, the second whether its alias stands in.
    uint32_t sample(Vec2 u) const {
        const auto last = static_cast<uint32_t>(bins_.size()) - 1;
        const uint32_t chosen = static_cast<uint32_t>(u.x * static_cast<float>(bins_.size()));
        const uint32_t bin = chosen < last ? chosen : last;
        return u.y < bins_[bin].keep ? bin : bins_[bin].alias;
    }
    /// Probability of drawing `index`.
    float probability(uint32_t index) const { return bins_[index].probability; }
    size_t byteCount() const { return bins_.capacity() * sizeof(Bin); }

private:
    struct Bin {
        float keep = 1;
        uint32_t alias = 0;
        float probability = 0;
    };
    std::vector<Bin> bins_;
};

}  // namespace lumi
