#pragma once
#include <vector>

#include "trace/albedo_table.h"
#include "trace/ggx.h"

namespace lumi {

/// SchlickAlbedo of stretched facets: over the roughness along x and along y, the cosine and the azimuth. What is
/// tabled is the difference to isotropic facets of the roughness that lies along the direction, which varies slowly.
/// Off by less than 0.01.
class AnisotropicAlbedo {
public:
    /// Made at first use (some 200 ms); any thread.
    static const AnisotropicAlbedo& get();

    Vec2 directional(const Ggx& ggx, const Vec3& w) const;
    /// Mean over the hemisphere weighted by the cosine.
    Vec2 average(const Ggx& ggx) const;

private:
    static constexpr int kRows = 12, kColumns = 24, kAzimuths = 9;
    AnisotropicAlbedo();
    Vec2 difference(RoughnessRow x, RoughnessRow y, float cosTheta, float azimuth) const;
    static size_t cell(int x, int y) { return static_cast<size_t>(x * kRows + y); }

    std::vector<Vec2> difference_;  ///< [x][y][azimuth][cosine]
    std::vector<Vec2> average_;     ///< [x][y]
};

}  // namespace lumi
