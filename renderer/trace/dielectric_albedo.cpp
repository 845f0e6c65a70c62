#include "trace/dielectric_albedo.h"

#include <atomic>
#include <memory>

#include "trace/fresnel.h"
#include "trace/ggx.h"
#include "trace/visible_normals.h"

namespace lumi {
namespace {

Vec3 directionAt(float cosTheta) {
    cosTheta = std::max(cosTheta, 1e-5f);
    return {std::sqrt(std::max(0.0f, 1 - cosTheta * cosTheta)), 0, cosTheta};
}

using CoarseLattice = FibonacciLattice<233, 144>;
using FineLattice = FibonacciLattice<987, 610, 1>;
using FinestLattice = FibonacciLattice<2584, 1597, 1>;

template <size_t Columns, size_t Rows>
float bilinear(const std::array<std::array<float, Columns>, Rows>& table, RoughnessRow at, float column) {
    const int first = std::clamp(static_cast<int>(column), 0, static_cast<int>(Columns) - 2);
    const float f = column - static_cast<float>(first);
    const float* low = table[static_cast<size_t>(at.row)].data() + first;
    const float* high = table[static_cast<size_t>(at.row) + 1].data() + first;
    const float a = low[0] + (low[1] - low[0]) * f;
    const float b = high[0] + (high[1] - high[0]) * f;
    return a + (b - a) * at.fraction;
}

/// Share of light that a facet reflects.
float reflectance(float cosTheta, float eta, bool clear) {
    const float f = fresnelDielectric(std::min(cosTheta, 1.0f), eta);
    return clear && (eta > 1 || f < 1) ? 0 : f;
}

/// What neither leaves by reflection nor by refraction, of light that meets facets seen from `wo`.
template <class Points>
float lostBy(const Ggx& ggx, const Vec3& wo, float eta, bool clear) {
    const float lambdaO = ggx.lambda(wo);
    return meanOverVisibleNormals<Points>(ggx, wo, [&](const Vec3& h) {
        const float f = reflectance(glm::dot(wo, h), eta, clear);
        float kept = f * reflectedShare(ggx, wo, lambdaO, h);
        Vec3 wi;
        if (f < 1 && refract(wo, h, eta, wi) && wi.z < 0)
            kept += (1 - f) * (1 + lambdaO) * maskingBothSides(lambdaO, ggx.lambda(wi));
        return 1 - kept;
    });
}

/// By the midpoint rule in the cosine of transmitted light, which the Fresnel term is smooth in.
float fresnelMean(float eta) {
    constexpr int kSteps = 400;
    // Through the boundary goes n^2 (1 - mean) as seen from the denser side: light enters as it leaves.
    const float dense = std::max(eta, 1 / eta);
    float passed = 0;
    for (int i = 0; i < kSteps; ++i) {
        const float c = (static_cast<float>(i) + 0.5f) / kSteps;
        passed += (1 - fresnelDielectric(c, dense)) * 2 * c / kSteps;
    }
    return eta >= 1 ? 1 - passed : 1 - passed * sqr(eta);
}

}  // namespace

DielectricAlbedo::DielectricAlbedo(float eta, bool clear) : clear_(clear) {
    if (eta < 1) {
        cosCritical_ = std::sqrt(1 - eta * eta);
        criticalColumn_ = (kColumns - 1) / 2;
        invCritical_ = 1 / cosCritical_;
        invBeyond_ = 1 / (eta * eta);
    }
    averageFresnel_ = clear ? std::max(0.0f, 1 - eta * eta) : fresnelMean(eta);
    tabulateReflected(eta);
    tabulateLost(eta);
}

void DielectricAlbedo::tabulateReflected(float eta) {
    for (int row = 0; row < kRows; ++row) {
        const Ggx ggx{sqr(RoughnessRow::roughnessOf(row, kRows))};
        for (int column = 0; column < kColumns; ++column) {
            const Vec3 wo = directionAt(cosineAt(static_cast<float>(column)));
            const float lambdaO = ggx.lambda(wo);
            const auto byFacet = [&](const Vec3& h) {
                return reflectance(glm::dot(wo, h), eta, clear_) * reflectedShare(ggx, wo, lambdaO, h);
            };
            // The kink at the critical angle wants a finer grid.
            reflected_[static_cast<size_t>(row)][static_cast<size_t>(column)] =
                eta < 1 ? meanOverVisibleNormals<FineLattice>(ggx, wo, byFacet)
                        : meanOverVisibleNormals<CoarseLattice>(ggx, wo, byFacet);
        }
    }
}

void DielectricAlbedo::tabulateLost(float eta) {
    // Where total reflection begins is a kink, and of a clear boundary a step.
    margin_ = eta >= 1 ? 5e-4f : clear_ ? 5e-3f : 1.5e-3f;
    for (int row = 0; row < kRows; ++row) {
        const Ggx ggx{sqr(RoughnessRow::roughnessOf(row, kRows))};
        for (int column = 0; column < kLossColumns; ++column) {
            const float c = FacetView::cosineAt(static_cast<float>(column) / (kLossColumns - 1), ggx.alpha);
            const Vec3 wo = directionAt(c);
            lost_[static_cast<size_t>(row)][static_cast<size_t>(column)] =
                std::max(0.0f, eta < 1 ? lostBy<FinestLattice>(ggx, wo, eta, clear_)
                                       : lostBy<FineLattice>(ggx, wo, eta, clear_));
        }
    }
    for (int row = 0; row < kMeanRows; ++row) {
        const float roughness = RoughnessRow::roughnessOf(row, kMeanRows), alpha = sqr(roughness);
        const RoughnessRow at(roughness, kRows);
        averageReturned_[static_cast<size_t>(row)] =
            meanOverColumns(alpha, [&](const FacetView& view) { return returned(at, view); }) / sqr(alpha);
    }
}

// Columns are even in the root of the cosine; where total reflection exists the reflectance has a vertical tangent at
// the critical angle, so one column lies there and the others crowd towards it quadratically from both sides.
float DielectricAlbedo::columnOf(float cosTheta) const {
    const float c = std::clamp(cosTheta, 0.0f, 1.0f);
    if (cosCritical_ == 0) return std::sqrt(c) * (kColumns - 1);
    if (c <= cosCritical_)
        return std::asin(std::sqrt(std::min(c * invCritical_, 1.0f))) * (2 * kInvPi) * criticalColumn_;
    const float cosT = std::sqrt(std::max(0.0f, (c * c - cosCritical_ * cosCritical_) * invBeyond_));
    return criticalColumn_ + std::min(cosT, 1.0f) * (kColumns - 1 - criticalColumn_);
}

float DielectricAlbedo::cosineAt(float column) const {
    if (cosCritical_ == 0) return sqr(column / (kColumns - 1));
    if (column <= criticalColumn_) return cosCritical_ * sqr(std::sin(column / criticalColumn_ * (kPi / 2)));
    const float cosT = (column - criticalColumn_) / (kColumns - 1 - criticalColumn_);
    return std::sqrt(cosCritical_ * cosCritical_ + cosT * cosT / invBeyond_);
}

float DielectricAlbedo::reflected(RoughnessRow at, float cosTheta) const {
    return bilinear(reflected_, at, columnOf(cosTheta));
}

float DielectricAlbedo::lost(RoughnessRow at, FacetView view) const {
    return bilinear(lost_, at, view.column * (kLossColumns - 1));
}

float DielectricAlbedo::averageReturned(RoughnessRow at, float alpha) const {
    at = at.finer(kMeanSteps, kMeanRows);
    const size_t row = static_cast<size_t>(at.row);
    const float mean = averageReturned_[row] + (averageReturned_[row + 1] - averageReturned_[row]) * at.fraction;
    return std::max(mean * sqr(alpha), 1e-12f);
}

namespace {

constexpr int kIorSteps = 1024, kMinIor = kIorSteps / 4, kMaxIor = kIorSteps * 4;

struct BothSides {
    DielectricAlbedo entering, leaving;
    BothSides(float ior, bool clear) : entering(ior, clear), leaving(1 / ior, clear) {}
};

using Slots = std::array<std::atomic<const BothSides*>, kMaxIor - kMinIor + 1>;
Slots tables{}, clearTables{};

int stepOf(float ior) {
    return std::clamp(static_cast<int>(std::lround(std::clamp(ior, 0.0f, 8.0f) * kIorSteps)), kMinIor, kMaxIor);
}

}  // namespace

float DielectricAlbedo::roundedIor(float ior) { return static_cast<float>(stepOf(ior)) / kIorSteps; }

const DielectricAlbedo& DielectricAlbedo::get(float ior, bool entering, bool clear) {
    auto& slot = (clear ? clearTables : tables)[static_cast<size_t>(stepOf(ior) - kMinIor)];
    const BothSides* table = slot.load(std::memory_order_acquire);
    if (table == nullptr) {
        // Threads that meet a new index together each make the table, and the first to finish is believed: a lock
        // here could be waited for by a worker that the maker itself needs.
        auto made = std::make_unique<BothSides>(roundedIor(ior), clear);
        if (slot.compare_exchange_strong(table, made.get(), std::memory_order_acq_rel)) table = made.release();
    }
    return entering ? table->entering : table->leaving;
}

}  // namespace lumi
