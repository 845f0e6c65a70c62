#include "trace/sheen.h"

#include <array>
#include <cmath>

namespace lumi {
namespace {

/// The paper's fit, at cosines below one half; above it is mirrored.
float fitted(float alpha, float x) {
    const float t = sqr(1 - alpha);
    const auto between = [&](float rough, float smooth) { return rough + (smooth - rough) * t; };
    const float a = between(21.5473f, 25.3245f), b = between(3.82987f, 3.32435f), c = between(0.19823f, 0.16801f);
    return a / (1 + b * std::pow(x, c)) + between(-1.97760f, -1.27393f) * x + between(-4.32054f, -4.85967f);
}

float lambda(float alpha, float cosTheta) {
    const float c = std::min(cosTheta, 1.0f);
    return std::exp(c < 0.5f ? fitted(alpha, c) : 2 * fitted(alpha, 0.5f) - fitted(alpha, 1 - c));
}

/// f cos(wi) of white sheen.
float value(float alpha, const Vec3& wo, float lambdaO, const Vec3& wi, float lambdaI) {
    const Vec3 h = halfVector(wo + wi);
    const float sine2 = std::max(h.x * h.x + h.y * h.y, 0.0f);
    const float distribution = (2 + 1 / alpha) * std::pow(sine2, 0.5f / alpha) * (0.5f * kInvPi);
    return distribution / ((1 + lambdaO + lambdaI) * 4 * wo.z);
}

/// A function of (roughness, cosine): rows crowd at the least roughness, columns are even in the root of the cosine.
struct Grid {
    static constexpr int kRows = 24, kColumns = 48;
    std::array<std::array<float, kColumns>, kRows> entries{};

    template <class Value>
    void fill(const Value& valueAt) {
        for (int row = 0; row < kRows; ++row) {
            const float least = Sheen::kLeastRoughness;
            const float roughness = least + (1 - least) * sqr(static_cast<float>(row) / (kRows - 1));
            for (int column = 0; column < kColumns; ++column)
                entries[static_cast<size_t>(row)][static_cast<size_t>(column)] =
                    valueAt(roughness, std::max(sqr(static_cast<float>(column) / (kColumns - 1)), kMinCosine));
        }
    }

    float at(float roughness, float cosTheta) const {
        const float above = (roughness - Sheen::kLeastRoughness) / (1 - Sheen::kLeastRoughness);
        const float y = std::sqrt(std::max(above, 0.0f)) * (kRows - 1);
        const float x = std::sqrt(std::min(cosTheta, 1.0f)) * (kColumns - 1);
        const int row = std::clamp(static_cast<int>(y), 0, kRows - 2);
        const int column = std::clamp(static_cast<int>(x), 0, kColumns - 2);
        const float fy = y - static_cast<float>(row), fx = x - static_cast<float>(column);
        const float* a = &entries[static_cast<size_t>(row)][static_cast<size_t>(column)];
        const float* b = &entries[static_cast<size_t>(row) + 1][static_cast<size_t>(column)];
        return (a[0] + (a[1] - a[0]) * fx) * (1 - fy) + (b[0] + (b[1] - b[0]) * fx) * fy;
    }
};

/// The fit reflects more than arrives where light grazes smooth fibres. Dividing by that excess at both ends keeps the
/// lobe reciprocal and below 1.
struct Tables {
    Grid unlimited;  ///< directional albedo of the fit
    Grid limited;    ///< and of what is used

    Tables() {
        unlimited.fill([](float roughness, float c) { return integral(roughness, c, [](float) { return 1.0f; }); });
        limited.fill([&](float roughness, float c) {
            return integral(roughness, c, [&](float cosI) { return 1 / excess(roughness, cosI); }) /
                   excess(roughness, c);
        });
    }

    float excess(float roughness, float cosTheta) const { return std::max(1.0f, unlimited.at(roughness, cosTheta)); }

    /// Midpoint rule over half the hemisphere, rings crowded at the horizon.
    template <class Weight>
    static float integral(float roughness, float cosTheta, const Weight& weight) {
        constexpr int kRings = 48, kSectors = 24;
        const Vec3 wo(std::sqrt(1 - cosTheta * cosTheta), 0, cosTheta);
        const float alpha = sqr(roughness), lambdaO = lambda(alpha, cosTheta);
        float sum = 0;
        for (int ring = 0; ring < kRings; ++ring) {
            const float x = (static_cast<float>(ring) + 0.5f) / kRings, z = x * x, r = std::sqrt(1 - z * z);
            const float lambdaI = lambda(alpha, z), ringWeight = 2 * x * weight(z);
            for (int sector = 0; sector < kSectors; ++sector) {
                const float phi = kPi * (static_cast<float>(sector) + 0.5f) / kSectors;
                sum += ringWeight * value(alpha, wo, lambdaO, {r * std::cos(phi), r * std::sin(phi), z}, lambdaI);
            }
        }
        return sum * 2 * kPi / (kRings * kSectors);
    }
};

const Tables& tables() {
    static const Tables made;
    return made;
}

}  // namespace

Sheen::Sheen(const LayerInputs& layers, const Vec3& wo)
    : color_(saturate(layers.sheenColor)),
      wo_(wo),
      roughness_(std::max(saturate(layers.sheenRoughness), kLeastRoughness)) {
    lambdaO_ = lambda(sqr(roughness_), wo.z);
    excessO_ = tables().excess(roughness_, wo.z);
    directional_ = std::min(tables().limited.at(roughness_, wo.z), 1.0f);
}

LobeValue Sheen::evaluate(const Vec3& wi) const {
    if (wi.z <= 0) return {};
    const float alpha = sqr(roughness_), excess = excessO_ * tables().excess(roughness_, wi.z);
    return {color_ * (value(alpha, wo_, lambdaO_, wi, lambda(alpha, wi.z)) / excess), 0.5f * kInvPi};
}

Vec3 Sheen::sample(Vec2 u) const {
    const float z = 1 - u.x, r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * kPi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

void Sheen::prepare() { tables(); }

}  // namespace lumi
