#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "math/statistics.h"
#include "physics/bsdf/materials.h"
#include "trace/albedo_table.h"
#include "trace/sampler.h"

namespace lumi::test {
namespace {

constexpr int kCosines = 20, kAzimuths = 24, kCells = kCosines * kAzimuths;

struct Cell {
    double z0, z1, phi0, phi1;
};

Cell cellAt(int index) {
    const int row = index / kAzimuths, column = index % kAzimuths;
    return {-1 + 2.0 * row / kCosines, -1 + 2.0 * (row + 1) / kCosines, 2 * M_PI * column / kAzimuths,
            2 * M_PI * (column + 1) / kAzimuths};
}

int cellOf(const Vec3& w) {
    double phi = std::atan2(w.y, w.x);
    if (phi < 0) phi += 2 * M_PI;
    const int row = std::clamp(static_cast<int>((w.z + 1.0) / 2 * kCosines), 0, kCosines - 1);
    const int column = std::clamp(static_cast<int>(phi / (2 * M_PI) * kAzimuths), 0, kAzimuths - 1);
    return row * kAzimuths + column;
}

double gauss(const Bsdf& bsdf, const Cell& cell) {
    static constexpr double kNode[3] = {0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417};
    static constexpr double kWeight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double z = cell.z0 + (cell.z1 - cell.z0) * kNode[i];
            const double phi = cell.phi0 + (cell.phi1 - cell.phi0) * kNode[j];
            const double r = std::sqrt(1 - z * z);
            const Vec3 wi(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                          static_cast<float>(z));
            sum += kWeight[i] * kWeight[j] * bsdf.evaluate(wi).pdf;
        }
    return sum * (cell.z1 - cell.z0) * (cell.phi1 - cell.phi0);
}

/// Halves the cell both ways until the halves agree with the whole.
double integratePdf(const Bsdf& bsdf, const Cell& cell, double whole, int depth) {
    const double z = 0.5 * (cell.z0 + cell.z1), phi = 0.5 * (cell.phi0 + cell.phi1);
    const Cell quarters[4] = {{cell.z0, z, cell.phi0, phi},
                              {cell.z0, z, phi, cell.phi1},
                              {z, cell.z1, cell.phi0, phi},
                              {z, cell.z1, phi, cell.phi1}};
    double parts[4], sum = 0;
    for (int i = 0; i < 4; ++i) sum += parts[i] = gauss(bsdf, quarters[i]);
    if (depth == 0 || std::abs(sum - whole) < 1e-6) return sum;
    sum = 0;
    for (int i = 0; i < 4; ++i) sum += integratePdf(bsdf, quarters[i], parts[i], depth - 1);
    return sum;
}

double deltaShare(const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3& wo) {
    const glm::dvec3 n = coatNormal(inputs, wo);
    const bool above = 2 * glm::dot(n, glm::dvec3(wo)) * n.z > wo.z;
    const bool coat = inputs.layers.clearcoatRoughness < Bsdf::kDeltaRoughness && above;
    const float onTop = coat ? bsdf.probability(Lobe::Clearcoat) : 0;
    if (inputs.roughness >= Bsdf::kDeltaRoughness || inputs.layers.anisotropy > 0) return onTop;
    return onTop + bsdf.probability(Lobe::SpecularReflection) + bsdf.probability(Lobe::SpecularTransmission);
}

/// Mirrors lose no sample; a coat that leans may lose all. Facets of a coat lose those that reflect downwards, and
/// those weigh nothing in its albedo while the others weigh 1 at most: what facets that reflect everything lack bounds
/// them.
double mostLostByCoat(const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3& wo) {
    const float roughness = inputs.layers.clearcoatRoughness;
    if (coatNormal(inputs, wo).z < 1) return bsdf.probability(Lobe::Clearcoat);
    if (roughness < Bsdf::kDeltaRoughness) return 0;
    const Vec2 all = SchlickAlbedo::get().directional(RoughnessRow(roughness), {sqr(roughness), wo.z});
    return bsdf.probability(Lobe::Clearcoat) * (1 - all.x - all.y);
}

// Directions fall as pdf says, in cells of the whole sphere; deltas and absorbed samples are two more cells. That the
// pdf integrates to what is neither is part of it: cells and shares must add up to 1.
TEST(BsdfDistribution, ChiSquare) {
    constexpr int kSamples = 60000;
    const std::vector<float> roughnesses{0, 0.2f, 0.5f, 1}, cosines{0.95f, 0.5f, 0.15f};
    const auto tests = static_cast<int64_t>(materials().size() * roughnesses.size() * cosines.size());
    const double level = sidakLevel(0.01, tests);
    forEachBsdf(roughnesses, cosines,
                [&](const Bsdf& bsdf, const BsdfInputs& inputs, const Vec3& wo, const auto& label) {
                    // A needle of a lobe, too narrow for these cells: NarrowLobesInTheirOwnCells has it.
                    if (inputs.roughness == 0 && inputs.layers.anisotropy > 0) return;
                    std::vector<double> observed(kCells + 2), expected(kCells + 2);
                    double integral = 0;
                    for (int cell = 0; cell < kCells; ++cell) {
                        const double share = integratePdf(bsdf, cellAt(cell), gauss(bsdf, cellAt(cell)), 8);
                        // Quadrature may miss the corner of a cell that the edge of a lobe cuts.
                        expected[static_cast<size_t>(cell)] = std::max(share * kSamples, 0.005);
                        integral += share;
                    }
                    for (uint32_t i = 0; i < kSamples; ++i) {
                        const SampleStream stream(SamplerKind::Independent, 0, 7, {1, 2, i});
                        const BsdfSample s = bsdf.sample(stream.get1(0), stream.get2(2));
                        const int cell = s.lobe == Lobe::None ? kCells : s.delta ? kCells + 1 : cellOf(s.wi);
                        observed[static_cast<size_t>(cell)] += 1;
                    }
                    expected[kCells + 1] = deltaShare(bsdf, inputs, wo) * kSamples;
                    // What is absorbed has no density of its own: what the others leave.
                    const double absorbed = 1 - integral - deltaShare(bsdf, inputs, wo);
                    EXPECT_GE(absorbed, -2e-4) << label;
                    const double most = inputs.roughness == 0 ? mostLostByCoat(bsdf, inputs, wo) + 2e-4 : 1;
                    EXPECT_LE(absorbed, most) << label;
                    expected[kCells] = std::max(absorbed, 0.0) * kSamples;
                    if (expected[kCells] < 0.1) {
                        EXPECT_LE(observed[kCells], 3) << label;
                        expected[kCells] = observed[kCells];
                    }
                    EXPECT_GT(chiSquareTest(observed, expected), level) << label;
                });
}

// Lobes too narrow for cells of directions, in cells of the facets that make them: even shares of the normals' own
// distribution, by azimuth. Whatever does not reflect is one more cell. Broad lobes are left out: they fall into the
// few steepest facets.
TEST(BsdfDistribution, NarrowLobesInTheirOwnCells) {
    constexpr int kSamples = 20000, kShares = 8, kTurns = 12, kInner = 24;
    const std::vector<float> roughnesses{0, 0.02f, 0.06f};
    const double level = sidakLevel(0.01, 200);
    const auto check = [&](const Bsdf&, const BsdfInputs& given, const Vec3& wo, const std::string& label) {
        BsdfInputs inputs = given;
        inputs.multipleScattering = false;
        Bsdf bsdf(inputs, wo);
        bsdf.keep(false, true);
        if (bsdf.probability(Lobe::SpecularReflection) == 0) return;
        const bool stretched = inputs.layered && inputs.layers.anisotropy > 0;
        if (inputs.layers.clearcoat > 0 || !isBlack(inputs.layers.sheenColor)) return;
        if (inputs.roughness < Bsdf::kDeltaRoughness && !stretched) return;
        const Facets facets(inputs, Lobe::SpecularReflection);
        std::vector<double> observed(kShares * kTurns + 1), expected(observed.size());
        double sum = 0;
        for (int i = 0; i < kShares * kInner; ++i)
            for (int j = 0; j < kTurns * kInner; ++j) {
                double density;
                const double steeper = (i + 0.5) / (kShares * kInner), phi = 2 * M_PI * (j + 0.5) / (kTurns * kInner);
                const glm::dvec3 h = facets.at(steeper, phi, density),
                                 wi = 2 * glm::dot(glm::dvec3(wo), h) * h - glm::dvec3(wo);
                const double cosFacet = glm::dot(glm::dvec3(wo), h);
                if (cosFacet <= 0 || wi.z <= 0) continue;
                const double share =
                    bsdf.evaluate(Vec3(wi)).pdf * 4 * cosFacet / density / (kShares * kTurns * kInner * kInner);
                expected[static_cast<size_t>(i / kInner * kTurns + j / kInner)] += share * kSamples;
                sum += share;
            }
        for (uint32_t i = 0; i < kSamples; ++i) {
            const SampleStream stream(SamplerKind::Independent, 0, 21, {3, 2, i});
            const BsdfSample s = bsdf.sample(stream.get1(0), stream.get2(2));
            size_t cell = observed.size() - 1;
            if (s.lobe != Lobe::None && !s.delta && s.wi.z > 0) {
                const Vec2 at = facets.find(glm::normalize(glm::dvec3(wo) + glm::dvec3(s.wi)));
                cell = static_cast<size_t>(std::min(int(at.x * kShares), kShares - 1) * kTurns +
                                           std::min(int(at.y / (2 * kPi) * kTurns), kTurns - 1));
            }
            observed[cell] += 1;
        }
        expected.back() = std::max(1 - sum, 1e-6) * kSamples;
        EXPECT_GT(chiSquareTest(observed, expected), level) << label;
    };
    forEachBsdf(roughnesses, {0.95f, 0.15f}, check);
}

TEST(BsdfDistribution, SampleAgreesWithEvaluate) {
    forEachBsdf({0.02f, 0.1f, 0.4f, 1}, {0.95f, 0.4f, 0.05f},
                [](const Bsdf& bsdf, const BsdfInputs&, const Vec3&, const std::string& label) {
                    for (uint32_t i = 0; i < 500; ++i) {
                        const SampleStream stream(SamplerKind::Independent, 0, 9, {5, 6, i});
                        const BsdfSample s = bsdf.sample(stream.get1(0), stream.get2(2));
                        if (s.lobe == Lobe::None || s.delta) continue;
                        const BsdfValue value = bsdf.evaluate(s.wi);
                        // A narrow lobe loses digits between the facet drawn and the facet found again.
                        ASSERT_NEAR(s.pdf / value.pdf, 1, 0.02) << label;
                        const Vec3 sum = value.diffuse + value.specular;
                        for (int c = 0; c < 3; ++c)
                            ASSERT_NEAR(s.weight[c] * value.pdf, sum[c], 0.002 * sum[c] + 1e-6 * value.pdf) << label;
                        Vec3 lobes(0);
                        for (const Lobe lobe : kLobes) lobes += bsdf.evaluate(s.wi, lobe);
                        ASSERT_NEAR(lobes.x, sum.x, 1e-5 * sum.x) << label;
                    }
                });
}

TEST(BsdfDistribution, EveryLiveLobeIsDrawn) {
    forEachBsdf({0, 0.3f}, {1, 0.5f, 0.01f}, [](const Bsdf& bsdf, const BsdfInputs&, const Vec3&, const auto& label) {
        float sum = 0;
        for (const Lobe lobe : kLobes) {
            const float p = bsdf.probability(lobe);
            sum += p;
            EXPECT_EQ(isBlack(bsdf.albedo(lobe)), p == 0) << label;
            EXPECT_GE(p, 0.04f * maxComponent(bsdf.albedo(lobe))) << label;
        }
        EXPECT_NEAR(sum, 1, 1e-6f) << label;
    });
}

TEST(BsdfDistribution, KeepTakesLobesAway) {
    BsdfInputs inputs;
    inputs.transmission = 0.5f;
    inputs.baseColor = Vec3(0.8f);
    for (const float roughness : {0.0f, 0.4f})
        for (const bool diffuse : {true, false}) {
            inputs.roughness = roughness;
            const Vec3 wo = directionAt(0.7f);
            const Bsdf whole(inputs, wo);
            Bsdf part = whole;
            part.keep(diffuse, !diffuse);
            EXPECT_EQ(isBlack(part.albedo(Lobe::Diffuse)), !diffuse);
            EXPECT_EQ(isBlack(part.specularAlbedo()), diffuse);
            const Vec3 wi = glm::normalize(Vec3(-0.5f, -0.2f, 0.8f));
            EXPECT_EQ(part.evaluate(wi).diffuse, diffuse ? whole.evaluate(wi).diffuse : Vec3(0));
            EXPECT_EQ(part.evaluate(wi).specular, diffuse ? Vec3(0) : whole.evaluate(wi).specular);
            for (const float u : {0.0f, 0.3f, 0.6f, 0.99f}) {
                const BsdfSample s = part.sample(u, {0.4f, 0.2f});
                ASSERT_NE(s.lobe, Lobe::None);
                EXPECT_EQ(s.lobe == Lobe::Diffuse, diffuse);
            }
            EXPECT_EQ(part.isDelta(), !diffuse && roughness == 0);
        }
    Bsdf nothing(inputs, directionAt(0.7f));
    nothing.keep(false, false);
    EXPECT_EQ(nothing.sample(0.5f, {0.5f, 0.5f}).lobe, Lobe::None);
}

// f(wo, wi) = f(wi, wo) for what stays on one side.
TEST(BsdfDistribution, Reciprocity) {
    for (const NamedMaterial& material : materials())
        for (const float roughness : {0.0f, 0.1f, 0.5f, 1.0f})
            for (uint32_t i = 0; i < 200; ++i) {
                const SampleStream stream(SamplerKind::Independent, 0, 11, {7, 8, i});
                Vec2 u = stream.get2(0), v = stream.get2(2);
                const auto direction = [](Vec2 s) {
                    const float z = 0.02f + 0.98f * s.x, r = std::sqrt(1 - z * z), phi = 2 * kPi * s.y;
                    return Vec3(r * std::cos(phi), r * std::sin(phi), z);
                };
                const Vec3 a = direction(u), b = direction(v);
                BsdfInputs inputs = material.inputs;
                inputs.roughness = roughness;
                for (const Lobe lobe : {Lobe::Diffuse, Lobe::SpecularReflection}) {
                    // What layers leave is their albedo towards wo alone, and so is a film's over the diffuse base.
                    const LayerInputs& layers = inputs.layers;
                    if (layers.clearcoat > 0 || !isBlack(layers.sheenColor)) continue;
                    if (layers.iridescence > 0 && lobe == Lobe::Diffuse) continue;
                    const Vec3 ab = Bsdf(inputs, a).evaluate(b, lobe) / b.z;
                    const Vec3 ba = Bsdf(inputs, b).evaluate(a, lobe) / a.z;
                    // Under stretched facets the share that reaches the base is found by quadrature towards wo, and
                    // looked up towards wi in a table that is off by up to 0.04.
                    const bool found = layers.anisotropy > 0 && lobe == Lobe::Diffuse;
                    for (int c = 0; c < 3; ++c)
                        ASSERT_NEAR(ab[c], ba[c], (found ? 0.05f : 1e-3f) * ab[c] + 1e-6f)
                            << material.name << " " << roughness;
                }
            }
}

}  // namespace
}  // namespace lumi::test
