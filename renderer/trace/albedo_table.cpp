#include "trace/albedo_table.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "trace/fresnel.h"
#include "trace/ggx.h"
#include "trace/visible_normals.h"

namespace lumi {
namespace {

Vec3 directionAt(float cosTheta) {
    cosTheta = std::max(cosTheta, 1e-4f);
    return {std::sqrt(std::max(0.0f, 1 - cosTheta * cosTheta)), 0, cosTheta};
}

using CoarseLattice = FibonacciLattice<233, 144>;
using FineLattice = FibonacciLattice<610, 377>;

template <size_t Columns>
Vec2 bilinear(const std::array<std::array<Vec2, Columns>, kAlbedoRows>& table, RoughnessRow at, float column) {
    const int first = std::clamp(static_cast<int>(column), 0, static_cast<int>(Columns) - 2);
    const float f = column - static_cast<float>(first);
    const Vec2* low = table[static_cast<size_t>(at.row)].data() + first;
    const Vec2* high = table[static_cast<size_t>(at.row) + 1].data() + first;
    const Vec2 a = low[0] + (low[1] - low[0]) * f;
    const Vec2 b = high[0] + (high[1] - high[0]) * f;
    return a + (b - a) * at.fraction;
}

}  // namespace

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

const SchlickAlbedo& SchlickAlbedo::get() {
    static const SchlickAlbedo table;
    return table;
}

SchlickAlbedo::SchlickAlbedo() {
    for (int row = 0; row < kAlbedoRows; ++row) {
        const Ggx ggx{sqr(RoughnessRow::roughnessOf(row))};
        auto& entries = directional_[static_cast<size_t>(row)];
        for (int column = 0; column < kColumns; ++column) {
            // Columns are even in the root of the cosine: grazing angles change fastest.
            const Vec3 wo = directionAt(sqr(static_cast<float>(column) / (kColumns - 1)));
            const float lambdaO = ggx.lambda(wo);
            entries[static_cast<size_t>(column)] = meanOverVisibleNormals<CoarseLattice>(ggx, wo, [&](const Vec3& h) {
                const float share = reflectedShare(ggx, wo, lambdaO, h);
                const float s = schlickWeight(glm::dot(wo, h));
                return Vec2(share * (1 - s), share * s);
            });
        }
        // With x the root of the cosine the mean is the integral of 4 x^3 E(x), in each cell a polynomial of degree
        // 4: three Gauss points make it exact.
        Vec2 sum(0);
        const float width = 1.0f / (kColumns - 1), offset = std::sqrt(0.6f);
        for (int cell = 0; cell < kColumns - 1; ++cell)
            for (int point = -1; point <= 1; ++point) {
                const float f = 0.5f + 0.5f * offset * static_cast<float>(point);
                const float x = (static_cast<float>(cell) + f) * width;
                const Vec2 e = glm::mix(entries[static_cast<size_t>(cell)], entries[static_cast<size_t>(cell) + 1], f);
                sum += (point == 0 ? 4.0f / 9 : 5.0f / 18) * width * 4 * x * x * x * e;
            }
        average_[static_cast<size_t>(row)] = sum;
    }
}

Vec2 SchlickAlbedo::directional(RoughnessRow at, float cosTheta) const {
    return bilinear(directional_, at, std::sqrt(std::clamp(cosTheta, 0.0f, 1.0f)) * (kColumns - 1));
}

Vec2 SchlickAlbedo::average(RoughnessRow at) const {
    const size_t row = static_cast<size_t>(at.row);
    return average_[row] + (average_[row + 1] - average_[row]) * at.fraction;
}

DielectricAlbedo::DielectricAlbedo(float eta) {
    if (eta < 1) {
        cosCritical_ = std::sqrt(1 - eta * eta);
        criticalColumn_ = (kColumns - 1) / 2;
        invCritical_ = 1 / cosCritical_;
        invBeyond_ = 1 / (eta * eta);
    }
    for (int row = 0; row < kAlbedoRows; ++row) {
        const Ggx ggx{sqr(RoughnessRow::roughnessOf(row))};
        for (int column = 0; column < kColumns; ++column) {
            const Vec3 wo = directionAt(cosineAt(static_cast<float>(column)));
            const float lambdaO = ggx.lambda(wo);
            const auto throughFacet = [&](const Vec3& h) {
                const float f = fresnelDielectric(std::min(glm::dot(wo, h), 1.0f), eta);
                Vec2 value(f * reflectedShare(ggx, wo, lambdaO, h), 0);
                Vec3 wi;
                if (f < 1 && refract(wo, h, eta, wi) && wi.z < 0)
                    value.y = (1 - f) * (1 + lambdaO) * maskingBothSides(lambdaO, ggx.lambda(wi));
                return value;
            };
            // The kink at the critical angle wants a finer grid.
            directional_[static_cast<size_t>(row)][static_cast<size_t>(column)] =
                eta < 1 ? meanOverVisibleNormals<FineLattice>(ggx, wo, throughFacet)
                        : meanOverVisibleNormals<CoarseLattice>(ggx, wo, throughFacet);
        }
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

Vec2 DielectricAlbedo::directional(RoughnessRow at, float cosTheta) const {
    return bilinear(directional_, at, columnOf(cosTheta));
}

namespace {

constexpr int kIorSteps = 1024, kMinIor = kIorSteps / 4, kMaxIor = kIorSteps * 4;

struct BothSides {
    DielectricAlbedo entering, leaving;
    explicit BothSides(float ior) : entering(ior), leaving(1 / ior) {}
};

std::array<std::atomic<const BothSides*>, kMaxIor - kMinIor + 1> tables{};

int stepOf(float ior) {
    return std::clamp(static_cast<int>(std::lround(std::clamp(ior, 0.0f, 8.0f) * kIorSteps)), kMinIor, kMaxIor);
}

}  // namespace

float DielectricAlbedo::roundedIor(float ior) { return static_cast<float>(stepOf(ior)) / kIorSteps; }

const DielectricAlbedo& DielectricAlbedo::get(float ior, bool entering) {
    auto& slot = tables[static_cast<size_t>(stepOf(ior) - kMinIor)];
    const BothSides* table = slot.load(std::memory_order_acquire);
    if (table == nullptr) {
        // Threads that meet a new index together each make the table, and the first to finish is believed: a lock
        // here could be waited for by a worker that the maker itself needs.
        auto made = std::make_unique<BothSides>(roundedIor(ior));
        if (slot.compare_exchange_strong(table, made.get(), std::memory_order_acq_rel)) table = made.release();
    }
    return entering ? table->entering : table->leaving;
}

}  // namespace lumi
