#pragma once
#include <array>

#include "trace/albedo_table.h"

namespace lumi {

/// GGX boundary between two dielectrics under the exact Fresnel term, seen from one side: what single scattering
/// reflects, and what it loses because light would have to meet a second facet. Both are off by less than 0.004, but
/// the former by up to 0.1 where light grazes nearly smooth facets. A clear boundary bends light the same but reflects
/// only what it cannot bend (see BoundaryFresnel): losses by less than 0.013, near the angle where that begins.
class DielectricAlbedo {
public:
    static constexpr int kRows = 32;

    /// Indices of refraction are rounded to multiples of 1/1024 in [1/4, 4], so that only so many tables can exist.
    static float roundedIor(float ior);

    /// `ior` as rounded; `entering`: light arrives and leaves on the side where the index is 1. Made at first use of
    /// an ior (some 200 ms) and kept; any thread, without waiting for others.
    static const DielectricAlbedo& get(float ior, bool entering, bool clear = false);

    DielectricAlbedo(float eta, bool clear);
    /// `at` among kRows; in [0,1].
    float reflected(RoughnessRow at, float cosTheta) const;
    float lost(RoughnessRow at, FacetView view) const;
    /// Of that, what can be given back for sure: less by the table's error.
    float returned(RoughnessRow at, FacetView view) const { return std::max(0.0f, lost(at, view) - margin_); }
    /// Mean of returned(), as interpolated, over the hemisphere weighted by the cosine. Above 0.
    float averageReturned(RoughnessRow at, float alpha) const;
    /// Mean of the Fresnel term over the hemisphere weighted by the cosine.
    float averageFresnel() const { return averageFresnel_; }

private:
    static constexpr int kColumns = 65, kLossColumns = 65, kMeanSteps = 4, kMeanRows = kMeanSteps * (kRows - 1) + 1;
    float columnOf(float cosTheta) const;
    float cosineAt(float column) const;
    void tabulateReflected(float eta);
    void tabulateLost(float eta);

    bool clear_ = false;
    float cosCritical_ = 0;  ///< cosine at which total reflection begins; 0 if it never does
    float criticalColumn_ = 0;
    float invCritical_ = 0, invBeyond_ = 1;
    float averageFresnel_ = 0;
    float margin_ = 0;
    std::array<std::array<float, kColumns>, kRows> reflected_;
    std::array<std::array<float, kLossColumns>, kRows> lost_;
    std::array<float, kMeanRows> averageReturned_;  ///< over alpha squared
};

}  // namespace lumi
