#include "measure/perceived.h"

#include <cmath>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "measure/convolve.h"
#include "measure/measure_kernels.h"

namespace lumi {
namespace {

constexpr double kPiExact = 3.14159265358979323846;

/// A contrast sensitivity function in the spatial domain: a sum of up to two Gaussians (table 1 of the paper).
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic{1, 0.0047, 0, 1e-5}, kRedGreen{1, 0.0053, 0, 1e-5},
    kBlueYellow{34.1, 0.04, 13.5, 0.025};

/// One of the two Gaussians as a separable filter, and its share of the kernel's total weight.
struct SeparableGaussian {
    std::vector<float> weights;  // sum 1
    double share;
};

int filterRadius() {
    // Three standard deviations of the widest Gaussian, the same for all channels.
    return static_cast<int>(
        std::ceil(3 * std::sqrt(kBlueYellow.b1 / (2 * kPiExact * kPiExact)) * kFlipPixelsPerDegree));
}

std::vector<SeparableGaussian> separate(const Sensitivity& s) {
    const int radius = filterRadius();
    std::vector<SeparableGaussian> parts;
    double total = 0;
    for (const auto& [a, b] : {std::pair{s.a1, s.b1}, std::pair{s.a2, s.b2}}) {
        if (a == 0) continue;
        std::vector<double> line;
        double sum = 0;
        for (int k = -radius; k <= radius; ++k) {
            const double z = k / static_cast<double>(kFlipPixelsPerDegree);
            line.push_back(std::exp(-kPiExact * kPiExact * z * z / b));
            sum += line.back();
        }
        SeparableGaussian part;
        for (const double w : line) part.weights.push_back(static_cast<float>(w / sum));
        part.share = a * std::sqrt(kPiExact / b) * sum * sum;
        total += part.share;
        parts.push_back(std::move(part));
    }
    for (SeparableGaussian& part : parts) part.share /= total;
    return parts;
}

void filterChannel(ConstFloatPlane in, const Sensitivity& sensitivity, FloatPlane out) {
    const std::vector<SeparableGaussian> parts = separate(sensitivity);
    Image scratch({in.width, in.height}, 1);
    for (size_t i = 0; i < parts.size(); ++i) {
        convolveClamped(in, parts[i].weights, parts[i].weights, scratch.plane(0));
        const auto share = static_cast<float>(parts[i].share);
        parallelRanges(in.height, 16, [&](int64_t begin, int64_t end) {
            for (int y = static_cast<int>(begin); y < end; ++y) {
                const float* smooth = scratch.plane(0).row(y);
                float* sum = out.row(y);
                for (int x = 0; x < in.width; ++x) sum[x] = (i == 0 ? 0.0f : sum[x]) + share * smooth[x];
            }
        });
    }
}

/// Gaussian and its first and second derivatives; positive and negative lobes each sum to 1 and -1 (sec. 4.2).
struct FeatureFilters {
    std::vector<float> smooth, edge, point;
};

FeatureFilters featureFilters() {
    const double sigma = 0.5 * 0.082 * kFlipPixelsPerDegree;  // half the width of a feature of 0.082 degrees
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    std::vector<double> g, e, p;
    double gSum = 0, ePositive = 0, pPositive = 0, pNegative = 0;
    for (int k = -radius; k <= radius; ++k) {
        const double value = std::exp(-k * k / (2 * sigma * sigma));
        g.push_back(value);
        e.push_back(-k * value);
        p.push_back((k * k / (sigma * sigma) - 1) * value);
        gSum += value;
        if (e.back() > 0) ePositive += e.back();
        (p.back() > 0 ? pPositive : pNegative) += p.back();
    }
    FeatureFilters filters;
    for (size_t k = 0; k < g.size(); ++k) {
        filters.smooth.push_back(static_cast<float>(g[k] / gSum));
        filters.edge.push_back(static_cast<float>(e[k] / ePositive));
        filters.point.push_back(static_cast<float>(p[k] / (p[k] > 0 ? pPositive : -pNegative)));
    }
    return filters;
}

/// cMax^qc: the largest HyAB distance of displayable colours, that of green and blue, after Hunt adjustment.
float largestDistance() {
    const auto lab = [](double r, double g, double b) {
        const double x = (0.4123865 * r + 0.3575915 * g + 0.1804505 * b) / 0.950428545;
        const double y = 0.2126368 * r + 0.7151830 * g + 0.0721802 * b;
        const double z = (0.0193306 * r + 0.1191972 * g + 0.9503726 * b) / 1.088900371;
        const auto curve = [](double t) { return t > 0.008856452 ? std::cbrt(t) : 7.787037037 * t + 0.137931034; };
        const double l = 116 * curve(y) - 16;
        return std::array<double, 3>{l, 0.01 * l * 500 * (curve(x) - curve(y)), 0.01 * l * 200 * (curve(y) - curve(z))};
    };
    const auto green = lab(0, 1, 0), blue = lab(0, 0, 1);
    const double distance = std::abs(green[0] - blue[0]) + std::hypot(green[1] - blue[1], green[2] - blue[2]);
    return static_cast<float>(std::pow(distance, 0.7));
}

}  // namespace

FlipFeatures flipFeatures(const Image& linear) {
    const Extent2 extent = linear.extent();
    Image opponent(extent, 3);
    const MeasureKernels& kernels = measureKernels();
    parallelRanges(extent.height, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y) {
            const float* in[] = {linear.plane(0).row(y), linear.plane(1).row(y), linear.plane(2).row(y)};
            float* out[] = {opponent.plane(0).row(y), opponent.plane(1).row(y), opponent.plane(2).row(y)};
            kernels.yCxCzFromLinear(in, out, extent.width);
        }
    });
    FlipFeatures features{Image(extent, 3), Image(extent, 4)};
    filterChannel(opponent.plane(0), kAchromatic, features.filtered.plane(0));
    filterChannel(opponent.plane(1), kRedGreen, features.filtered.plane(1));
    filterChannel(opponent.plane(2), kBlueYellow, features.filtered.plane(2));

    // Features live on the achromatic channel scaled to [0,1]; the offset matters at no border since edges are
    // extended.
    Image achromatic(extent, 1);
    parallelRanges(static_cast<int64_t>(achromatic.size()), 1 << 15, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) achromatic.data()[i] = (opponent.data()[i] + 16.0f) / 116.0f;
    });
    const FeatureFilters f = featureFilters();
    const ConstFloatPlane y = std::as_const(achromatic).plane(0);
    convolveClamped(y, f.edge, f.smooth, features.gradients.plane(0));
    convolveClamped(y, f.smooth, f.edge, features.gradients.plane(1));
    convolveClamped(y, f.point, f.smooth, features.gradients.plane(2));
    convolveClamped(y, f.smooth, f.point, features.gradients.plane(3));
    return features;
}

Image flipError(const FlipFeatures& test, const FlipFeatures& reference) {
    const Extent2 extent = test.filtered.extent();
    Image error(extent, 1);
    const float limit = largestDistance();
    const float remap[3] = {0.4f * limit, 0.95f, limit};
    const MeasureKernels& kernels = measureKernels();
    parallelRanges(extent.height, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y) {
            const float *colourT[3], *colourR[3], *gradientT[4], *gradientR[4];
            for (int c = 0; c < 3; ++c) {
                colourT[c] = test.filtered.plane(c).row(y);
                colourR[c] = reference.filtered.plane(c).row(y);
            }
            for (int c = 0; c < 4; ++c) {
                gradientT[c] = test.gradients.plane(c).row(y);
                gradientR[c] = reference.gradients.plane(c).row(y);
            }
            kernels.flipColour(colourT, colourR, remap, error.plane(0).row(y), extent.width);
            kernels.flipCombine(gradientT, gradientR, error.plane(0).row(y), extent.width);
        }
    });
    return error;
}

}  // namespace lumi
