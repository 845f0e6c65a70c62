#include "trace/albedo_table.h"

#include "trace/fresnel.h"
#include "trace/ggx.h"
#include "trace/visible_normals.h"

namespace lumi {

// Rows crowd towards the smooth end, three to one.
float RoughnessRow::roughnessOf(int row, int rows) {
    const float x = static_cast<float>(row) / static_cast<float>(rows - 1);
    return kTabledRoughness + (1 - kTabledRoughness) * 0.5f * (x + x * x);
}

RoughnessRow::RoughnessRow(float roughness, int rows) {
    const float above = std::max(0.0f, (roughness - kTabledRoughness) / (1 - kTabledRoughness));
    const float position = (std::sqrt(0.25f + 2 * above) - 0.5f) * static_cast<float>(rows - 1);
    row = std::clamp(static_cast<int>(position), 0, rows - 2);
    fraction = std::clamp(position - static_cast<float>(row), 0.0f, 1.0f);
}

float FacetView::cosineAt(float column, float alpha) {
    if (!(column > 0)) return 0;
    // (1 - z) / z of the stretched cosine z; written so that the digits near z = 1 are kept.
    const float k = sqr((1 - column) / column);
    return alpha / std::sqrt(2 * k + k * k + alpha * alpha);
}

const SchlickAlbedo& SchlickAlbedo::get() {
    static const SchlickAlbedo table;
    return table;
}

SchlickAlbedo::SchlickAlbedo() {
    for (int row = 0; row < kAlbedoRows; ++row) {
        const Ggx ggx{sqr(RoughnessRow::roughnessOf(row))};
        for (int column = 0; column < kColumns; ++column) {
            const float cosTheta = FacetView::cosineAt(static_cast<float>(column) / (kColumns - 1), ggx.alpha);
            const float c = std::max(cosTheta, 1e-5f);
            const Vec3 wo(std::sqrt(std::max(0.0f, 1 - c * c)), 0, c);
            const float lambdaO = ggx.lambda(wo);
            const Vec2 albedo = meanOverVisibleNormals<FibonacciLattice<610, 377>>(ggx, wo, [&](const Vec3& h) {
                const float share = reflectedShare(ggx, wo, lambdaO, h);
                const float s = schlickWeight(glm::dot(wo, h));
                return Vec2(share * (1 - s), share * s);
            });
            smooth_[static_cast<size_t>(row)][static_cast<size_t>(column)] =
                joined(albedo, FacetView(ggx.alpha, c).length);
        }
    }
    for (int row = 0; row < kMeanRows; ++row) {
        const float roughness = RoughnessRow::roughnessOf(row, kMeanRows), alpha = sqr(roughness);
        const RoughnessRow at(roughness);
        average_[static_cast<size_t>(row)] = meanOverColumns(alpha, [&](const FacetView& view) {
            const Vec2 albedo = directional(at, view);
            return Vec2((1 - albedo.x - albedo.y) / sqr(alpha), albedo.y);
        });
    }
}

// The sum of both is smooth as it is. Facets seen at a cosine near the stretched length give the share of y; what is
// left of it vanishes with the length.
Vec2 SchlickAlbedo::split(Vec2 smooth, float length) {
    const float y = std::clamp(smooth.x * schlickWeight(length) + length * smooth.y, 0.0f, smooth.x);
    return {smooth.x - y, y};
}

Vec2 SchlickAlbedo::joined(Vec2 albedo, float length) {
    const float sum = albedo.x + albedo.y;
    return {sum, (albedo.y - sum * schlickWeight(length)) / length};
}

Vec2 SchlickAlbedo::smooth(RoughnessRow at, float column) const {
    const float x = column * (kColumns - 1);
    const int first = std::clamp(static_cast<int>(x), 0, kColumns - 2);
    const float f = x - static_cast<float>(first);
    const Vec2* low = smooth_[static_cast<size_t>(at.row)].data() + first;
    const Vec2* high = smooth_[static_cast<size_t>(at.row) + 1].data() + first;
    const Vec2 a = low[0] + (low[1] - low[0]) * f;
    const Vec2 b = high[0] + (high[1] - high[0]) * f;
    return a + (b - a) * at.fraction;
}

Vec2 SchlickAlbedo::average(RoughnessRow at, float alpha) const {
    at = at.finer(kMeanSteps, kMeanRows);
    const size_t row = static_cast<size_t>(at.row);
    const Vec2 mean = average_[row] + (average_[row + 1] - average_[row]) * at.fraction;
    return {1 - mean.x * sqr(alpha) - mean.y, mean.y};
}

}  // namespace lumi
