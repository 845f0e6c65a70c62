#pragma once
#include <vector>

#include "trace/albedo_table.h"
#include "trace/ggx.h"

namespace lumi {

/// SchlickAlbedo of stretched facets: over the roughness along x and along y, and the direction as the facets see it
/// (FacetView's column, and an azimuth half way between the true and the stretched one). What is tabled is the
/// difference to isotropic facets whose squared ggxAlpha is the mean of both, which varies slowly. The pair's sum is
/// off by less than 0.005, and too small by less than 0.001; how it divides into the pair by less than 0.08 where light
/// grazes along the smooth direction, and little elsewhere.
class AnisotropicAlbedo {
public:
    /// Made at first use (some 300 ms); any thread.
    static const AnisotropicAlbedo& get();

    Vec2 directional(const Ggx& ggx, const Vec3& w) const;
    /// Mean over the hemisphere weighted by the cosine, as interpolated.
    Vec2 average(const Ggx& ggx) const;

private:
    static constexpr int kRows = 14, kColumns = 20, kAzimuths = 13, kMeanRows = 27;
    AnisotropicAlbedo();
    void tabulateDifference();
    void tabulateAverage();
    Vec2 difference(RoughnessRow x, RoughnessRow y, float column, float azimuth) const;
    static size_t cell(int x, int y) { return static_cast<size_t>(x * kRows + y) * kAzimuths * kColumns; }

    std::vector<Vec2> difference_;  ///< [x][y][azimuth][column]
    std::vector<Vec2> average_;     ///< [x][y], kMeanRows each: what is lost over the mean squared ggxAlpha, and y
};

}  // namespace lumi
