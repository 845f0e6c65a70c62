#include "trace/alias_table.h"

#include <cmath>

namespace lumi {

AliasTable::AliasTable(std::span<const float> weights) {
    double total = 0;
    const auto weight = [&](size_t i) {
        return weights[i] > 0 && std::isfinite(weights[i]) ? double(weights[i]) : 0.0;
    };
    for (size_t i = 0; i < weights.size(); ++i) total += weight(i);
    if (!(total > 0)) return;

    const auto count = static_cast<uint32_t>(weights.size());
    bins_.resize(count);
    std::vector<double> share(count);  // of a bin's room; 1 fills a bin
    std::vector<uint32_t> small, large;
    for (uint32_t i = 0; i < count; ++i) {
        share[i] = weight(i) / total * count;
        bins_[i] = {1, i, static_cast<float>(weight(i) / total)};
        (share[i] < 1 ? small : large).push_back(i);
    }
    // Fill each bin that is too small from one that is too large.
    while (!small.empty() && !large.empty()) {
        const uint32_t poor = small.back(), rich = large.back();
        small.pop_back();
        bins_[poor].keep = static_cast<float>(share[poor]);
        bins_[poor].alias = rich;
        share[rich] -= 1 - share[poor];
        if (share[rich] < 1) {
            large.pop_back();
            small.push_back(rich);
        }
    }
    // What rounding left over is full, but an index without weight must never come up.
    for (const uint32_t i : small)
        if (bins_[i].probability == 0) {
            uint32_t heaviest = 0;
            for (uint32_t k = 1; k < count; ++k)
                if (bins_[k].probability > bins_[heaviest].probability) heaviest = k;
            bins_[i].keep = 0;
            bins_[i].alias = heaviest;
        }
}

}  // namespace lumi
