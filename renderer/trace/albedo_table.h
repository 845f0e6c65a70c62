#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "math/vector.h"
#include "trace/albedo_view.h"

namespace lumi {

/// Directional albedos of the microfacet lobes: the share of light from everywhere that goes to one direction, tabled
/// by quadrature over roughness and a column (see FacetView) and interpolated linearly. Roughness is at least
/// kTabledRoughness; below it lobes are deltas with closed forms.
constexpr float kTabledRoughness = 0.02f;
constexpr int kAlbedoRows = 40;

/// Where a roughness lies among the rows of a table.
struct RoughnessRow {
    int row = 0;
    float fraction = 0;
    RoughnessRow() = default;
    explicit RoughnessRow(float roughness, int rows = kAlbedoRows);
    /// Of a table that has `times` as many steps, `rows` in all.
    RoughnessRow finer(int times, int rows) const {
        const float position = (static_cast<float>(row) + fraction) * static_cast<float>(times);
        RoughnessRow at;
        at.row = std::min(static_cast<int>(position), rows - 2);
        at.fraction = position - static_cast<float>(at.row);
        return at;
    }
    /// Roughness that lies on row `row` of `rows`.
    static float roughnessOf(int row, int rows = kAlbedoRows);
};

/// A direction as facets of roughness ggxAlpha `alpha` see it, stretched so that they have roughness 1. What masking
/// takes depends on little but the stretched cosine as long as slopes are small, so that a table over it resolves
/// grazing angles of smooth surfaces, where all happens within a cosine of about alpha.
struct FacetView {
    float column = 0;  ///< in [0,1]; even in the root of the stretched cosine there, and in its angle near the normal
    float length = 1;  ///< of the stretched vector

    FacetView(float alpha, float cosTheta) {
        const float c = std::clamp(cosTheta, 0.0f, 1.0f), side2 = alpha * alpha * (1 - c * c);
        length = std::sqrt(c * c + side2);
        column = 1 / (1 + std::sqrt(side2 / std::max((length + c) * c, 1e-30f)));
    }
    /// The cosine that lies on a column.
    static float cosineAt(float column, float alpha);
};

/// GGX reflection under Schlick's Fresnel term: albedo = F0 * x + F90 * y of the returned pair. Off by less than 0.001.
class SchlickAlbedo {
public:
    /// Made at first use (some 40 ms); any thread.
    static const SchlickAlbedo& get();

    Vec2 directional(RoughnessRow at, FacetView view) const { return split(smooth(at, view.column), view.length); }
    /// Mean of directional(), as interpolated, over the hemisphere weighted by the cosine.
    Vec2 average(RoughnessRow at, float alpha) const;

    /// The tables, for kernels.
    AlbedoView view() const {
        return {&smooth_[0][0].x, &average_[0].x, kAlbedoRows, kColumns, kMeanRows, kMeanSteps, kTabledRoughness};
    }

    /// What is interpolated, and how the pair follows from it.
    Vec2 smooth(RoughnessRow at, float column) const;
    static Vec2 split(Vec2 smooth, float length);
    /// The reverse of split().
    static Vec2 joined(Vec2 albedo, float length);

private:
    SchlickAlbedo();
    static constexpr int kColumns = 64;
    static constexpr int kMeanSteps = 4, kMeanRows = kMeanSteps * (kAlbedoRows - 1) + 1;
    std::array<std::array<Vec2, kColumns>, kAlbedoRows> smooth_;
    std::array<Vec2, kMeanRows> average_;  ///< what is lost over alpha squared, and y
};

/// Mean over the hemisphere, weighted by the cosine, of a function of FacetView columns at this ggxAlpha. Steps crowd
/// at the last column, into which smooth surfaces press nearly all directions.
template <class Value>
auto meanOverColumns(float alpha, const Value& valueAt) {
    constexpr int kSteps = 1024;
    decltype(valueAt(FacetView(alpha, 1))) sum(0);
    float previous = 1;
    for (int i = 0; i < kSteps; ++i) {
        const auto columnAt = [](float x) { return 1 - x * x; };
        const float next =
            i + 1 < kSteps ? FacetView::cosineAt(columnAt(static_cast<float>(i + 1) / kSteps), alpha) : 0;
        const float middle = FacetView::cosineAt(columnAt((static_cast<float>(i) + 0.5f) / kSteps), alpha);
        sum += (previous * previous - next * next) * valueAt(FacetView(alpha, middle));
        previous = next;
    }
    return sum;
}

}  // namespace lumi
