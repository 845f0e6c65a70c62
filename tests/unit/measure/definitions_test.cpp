// Each metric against a plain definition written here, on random images, and what must hold whatever the images are.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "base/parallel.h"
#include "math/colour.h"
#include "measure/metrics.h"

namespace lumi {
namespace {

Image randomImage(Extent2 extent, uint32_t seed, float scale = 1) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(0, scale);
    Image image(extent, 3);
    for (size_t i = 0; i < image.size(); ++i) image.data()[i] = uniform(generator);
    return image;
}

ImagePair randomPair(Extent2 extent = {67, 43}) {
    ImagePair pair{randomImage(extent, 1, 1.5f), randomImage(extent, 2, 1.5f), {}, 0};
    pair.prepare();
    return pair;
}

double ldr(float x) { return srgbFromLinear(std::min(std::max(x, 0.0f), 1.0f)); }

template <class F>
double meanOverValues(const ImagePair& pair, F error) {
    double sum = 0;
    for (size_t i = 0; i < pair.image.size(); ++i) sum += error(pair.image.data()[i], pair.reference.data()[i]);
    return sum / static_cast<double>(pair.image.size());
}

TEST(Definitions, PixelMetricsEqualTheirFormulas) {
    const ImagePair pair = randomPair();
    const double mse = meanOverValues(pair, [](double a, double b) { return (a - b) * (a - b); });
    const double ldrMse = meanOverValues(pair, [](float a, float b) { return (ldr(a) - ldr(b)) * (ldr(a) - ldr(b)); });
    EXPECT_NEAR(measureMse(pair, false).value, mse, 1e-6);
    EXPECT_NEAR(measureRmse(pair, false).value, std::sqrt(ldrMse), 1e-6);
    EXPECT_NEAR(measurePsnr(pair, false).value, -10 * std::log10(ldrMse), 1e-4);
    EXPECT_NEAR(measureMae(pair, false).value, meanOverValues(pair, [](double a, double b) { return std::abs(a - b); }),
                1e-6);
    EXPECT_NEAR(measureSmape(pair, false).value,
                meanOverValues(pair, [](double a, double b) { return 2 * std::abs(a - b) / (a + b + 0.01); }), 1e-6);
    double relMse = 0;
    for (int y = 0; y < pair.image.height(); ++y)
        for (int x = 0; x < pair.image.width(); ++x) {
            double squares = 0, gray = 0;
            for (int c = 0; c < 3; ++c) {
                squares += std::pow(double(pair.image.at(c, x, y)) - pair.reference.at(c, x, y), 2);
                gray += pair.reference.at(c, x, y) / 3.0;
            }
            relMse += squares / (gray * gray + 0.001);
        }
    EXPECT_NEAR(measureRelMse(pair, false).value, relMse / static_cast<double>(pair.image.extent().area()), 1e-5);
}

TEST(Definitions, SsimEqualsWindowByWindowSums) {
    const Image a = randomImage({31, 23}, 3), b = randomImage({31, 23}, 4);
    double weights[11], total = 0, sum = 0;
    for (int k = 0; k < 11; ++k) total += weights[k] = std::exp(-(k - 5) * (k - 5) / (2 * 1.5 * 1.5));
    int count = 0;
    for (int c = 0; c < 3; ++c)
        for (int y = 5; y < 23 - 5; ++y)
            for (int x = 5; x < 31 - 5; ++x, ++count) {
                double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
                for (int j = -5; j <= 5; ++j)
                    for (int i = -5; i <= 5; ++i) {
                        const double w = weights[i + 5] * weights[j + 5] / (total * total);
                        const double va = a.at(c, x + i, y + j), vb = b.at(c, x + i, y + j);
                        ma += w * va, mb += w * vb, aa += w * va * va, bb += w * vb * vb, ab += w * va * vb;
                    }
                sum += (2 * ma * mb + 1e-4) * (2 * (ab - ma * mb) + 9e-4) /
                       ((ma * ma + mb * mb + 1e-4) * (aa - ma * ma + bb - mb * mb + 9e-4));
            }
    EXPECT_NEAR(ssim(a, b), sum / count, 1e-5);
}

TEST(Definitions, IdenticalImagesGiveExactValues) {
    ImagePair pair{randomImage({200, 190}, 5, 2), randomImage({200, 190}, 5, 2), {}, 0};
    pair.prepare();
    for (const char* id : {"mse", "rmse", "mae", "relmse", "smape", "flip", "hdr_flip"})
        EXPECT_EQ(findMetric(id).measure(pair, false).value, 0) << id;
    EXPECT_EQ(measureSsim(pair, false).value, 1);
    EXPECT_EQ(measureMsSsim(pair, false).value, 1);
    EXPECT_TRUE(std::isinf(measurePsnr(pair, false).value));
}

TEST(Definitions, SymmetryIsAsDeclared) {
    const ImagePair pair = randomPair({190, 181});
    ImagePair swapped{pair.reference, pair.image, {}, 0};
    swapped.prepare();
    for (const Metric& metric : metricCatalog()) {
        const double there = metric.measure(pair, false).value, back = metric.measure(swapped, false).value;
        if (metric.symmetric) EXPECT_NEAR(there, back, 1e-9 + 1e-6 * std::abs(there)) << metric.id;
        else EXPECT_NE(there, back) << metric.id;
    }
}

TEST(Definitions, BrokenPixelsAreCountedAndLeftOut) {
    ImagePair clean = randomPair();
    ImagePair broken{clean.image, clean.reference, {}, 0};
    broken.image.at(1, 10, 12) = std::nanf("");
    broken.reference.at(0, 30, 20) = kInfinity;
    broken.prepare();
    EXPECT_EQ(broken.nonFinitePixels, 2);
    const double n = static_cast<double>(clean.image.extent().area());
    const Measurement all = measureMse(clean, true);
    const double without = (all.value * n - all.map.at(0, 10, 12) - all.map.at(0, 30, 20)) / (n - 2);
    EXPECT_NEAR(measureMse(broken, false).value, without, 1e-6);
    for (const Metric& metric : metricCatalog())
        EXPECT_FALSE(std::isnan(metric.measure(broken, false).value)) << metric.id;
}

TEST(Definitions, AMaskLeavesPixelsOut) {
    ImagePair pair = randomPair();
    pair.mask = Image(pair.image.extent(), 1);
    pair.mask.at(0, 5, 6) = 1;
    pair.prepare();
    double expected = 0;
    for (int c = 0; c < 3; ++c) expected += std::abs(pair.image.at(c, 5, 6) - pair.reference.at(c, 5, 6)) / 3;
    EXPECT_NEAR(measureMae(pair, false).value, expected, 1e-6);
}

TEST(Definitions, SizesMustAgree) {
    ImagePair pair{Image({4, 4}, 3), Image({4, 5}, 3), {}, 0};
    EXPECT_THROW(pair.prepare("a.exr"), Error);
}

TEST(Definitions, MapsHaveTheImagesExtentAndTheValueAsTheirMean) {
    const ImagePair pair = randomPair();
    for (const char* id : {"mse", "mae", "relmse", "smape", "flip", "hdr_flip"}) {
        const Measurement result = findMetric(id).measure(pair, true);
        ASSERT_EQ(result.map.extent(), pair.image.extent()) << id;
        EXPECT_NEAR(meanOverMask(result.map, pair), result.value, 1e-9) << id;
    }
}

TEST(Definitions, ResultsDoNotDependOnThreads) {
    const ImagePair pair = randomPair({190, 181});
    std::vector<double> values;
    for (const int threads : {1, 2, 8}) {
        setThreadCount(threads);
        for (const Metric& metric : metricCatalog()) values.push_back(metric.measure(pair, false).value);
    }
    setThreadCount(0);
    const size_t n = metricCatalog().size();
    for (size_t i = 0; i < n; ++i) {
        EXPECT_EQ(values[i], values[n + i]) << metricCatalog()[i].id;
        EXPECT_EQ(values[i], values[2 * n + i]) << metricCatalog()[i].id;
    }
}

TEST(Definitions, HdrFlipGuardsADarkReference) {
    ImagePair pair{randomImage({32, 32}, 8), Image({32, 32}, 3), {}, 0};
    pair.prepare();
    EXPECT_TRUE(std::isfinite(measureHdrFlip(pair, false).value));
    pair.reference.at(1, 3, 3) = 5;
    EXPECT_TRUE(std::isfinite(measureHdrFlip(pair, false).value));
}

TEST(Definitions, BlurLowersSharpness) {
    Image sharp({256, 256}, 1), blurred({256, 256}, 1);
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            const int phase = x % 32;
            sharp.at(0, x, y) = phase < 16 ? 40.0f : 210.0f;
            blurred.at(0, x, y) = 40 + 170 * std::min(1.0f, std::abs(phase - 16) / 12.0f);
        }
    EXPECT_EQ(cpbd(std::as_const(sharp).plane(0)), 1);
    EXPECT_LT(cpbd(std::as_const(blurred).plane(0)), 0.1);
}

}  // namespace
}  // namespace lumi
