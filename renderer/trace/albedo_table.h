#pragma once
#include <array>

#include "math/vector.h"

namespace lumi {

/// Directional albedos of the microfacet lobes: the share of light from everywhere that goes to one direction, tabled
/// over (cosine of that direction, roughness) by quadrature and interpolated linearly. Roughness is at least
/// kTabledRoughness; below it lobes are deltas with closed forms. Off by less than 0.004, but up to 0.04 in a narrow
/// band around the critical angle inside nearly smooth glass.
constexpr float kTabledRoughness = 0.02f;
constexpr int kAlbedoRows = 32;

/// Where a roughness lies among the rows of all tables.
struct RoughnessRow {
    int row = 0;
    float fraction = 0;
    RoughnessRow() = default;
    explicit RoughnessRow(float roughness, int rows = kAlbedoRows);
    /// Roughness that lies on row `row` of `rows`.
    static float roughnessOf(int row, int rows = kAlbedoRows);
};

/// GGX reflection under Schlick's Fresnel term: albedo = F0 * x + F90 * y of the returned pair.
class SchlickAlbedo {
public:
    /// Made at first use (some 10 ms); any thread.
    static const SchlickAlbedo& get();

    Vec2 directional(RoughnessRow at, float cosTheta) const;
    /// Mean of directional(), as interpolated, over the hemisphere weighted by the cosine.
    Vec2 average(RoughnessRow at) const;

private:
    SchlickAlbedo();
    static constexpr int kColumns = 65;
    std::array<std::array<Vec2, kColumns>, kAlbedoRows> directional_;
    std::array<Vec2, kAlbedoRows> average_;
};

/// GGX boundary between two dielectrics, exact Fresnel term: reflected and transmitted albedo (x, y).
class DielectricAlbedo {
public:
    /// Indices of refraction are rounded to multiples of 1/1024 in [1/4, 4], so that only so many tables can exist.
    static float roundedIor(float ior);

    /// `ior` as rounded; `entering`: light arrives and leaves on the side where the index is 1. Made at first use of
    /// an ior (some 10 ms) and kept; any thread, without waiting for others.
    static const DielectricAlbedo& get(float ior, bool entering);

    explicit DielectricAlbedo(float eta);
    Vec2 directional(RoughnessRow at, float cosTheta) const;

private:
    static constexpr int kColumns = 65;
    float columnOf(float cosTheta) const;
    float cosineAt(float column) const;

    float cosCritical_ = 0;  ///< cosine at which total reflection begins; 0 if it never does
    float criticalColumn_ = 0;
    float invCritical_ = 0, invBeyond_ = 1;
    std::array<std::array<Vec2, kColumns>, kAlbedoRows> directional_;
};

}  // namespace lumi
