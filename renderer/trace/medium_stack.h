#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

namespace lumi {

/// The solids that a path is in, by their materials, the one entered last first: an ice cube in a drink in a glass.
/// Of more than kMost the ones entered first are forgotten.
class MediumStack {
public:
    static constexpr size_t kMost = 4;
    static constexpr uint32_t kNone = ~0u;

    /// What absorbs: the innermost. kNone outside of all.
    uint32_t innermost() const { return materials_[0]; }
    void enter(uint32_t material) {
        for (size_t i = kMost - 1; i > 0; --i) materials_[i] = materials_[i - 1];
        materials_[0] = material;
    }
    /// Solids that overlap are left in any order; one that the path never entered changes nothing.
    void leave(uint32_t material) {
        size_t i = 0;
        while (i < kMost && materials_[i] != material) ++i;
        for (; i < kMost; ++i) materials_[i] = i + 1 < kMost ? materials_[i + 1] : kNone;
    }

    bool operator==(const MediumStack&) const = default;

private:
    std::array<uint32_t, kMost> materials_{kNone, kNone, kNone, kNone};
};

}  // namespace lumi
