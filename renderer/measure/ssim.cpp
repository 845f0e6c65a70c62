// SSIM [Wang 2004] and MS-SSIM [Wang 2003].
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "measure/convolve.h"
#include "measure/measure_kernels.h"
#include "measure/metrics.h"

namespace lumi {
namespace {

constexpr int kWindow = 11;

/// SSIM and its contrast-structure part at every window that lies inside; two channels.
Image ssimMaps(ConstFloatPlane a, ConstFloatPlane b) {
    const std::vector<float> weights = gaussianWeights(kWindow, 1.5);
    const Extent2 extent{a.width, a.height};
    Image products(extent, 3);
    parallelRanges(a.height, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y) {
            const float *ra = a.row(y), *rb = b.row(y);
            float *aa = products.plane(0).row(y), *bb = products.plane(1).row(y), *ab = products.plane(2).row(y);
            for (int x = 0; x < a.width; ++x) aa[x] = ra[x] * ra[x], bb[x] = rb[x] * rb[x], ab[x] = ra[x] * rb[x];
        }
    });
    const Image& p = products;
    const Image meanA = convolveInside(a, weights), meanB = convolveInside(b, weights);
    const Image squareA = convolveInside(p.plane(0), weights), squareB = convolveInside(p.plane(1), weights);
    const Image product = convolveInside(p.plane(2), weights);
    Image maps(meanA.extent(), 2);
    const MeasureKernels& kernels = measureKernels();
    parallelRanges(maps.height(), 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            kernels.ssimRow(meanA.plane(0).row(y), meanB.plane(0).row(y), squareA.plane(0).row(y),
                            squareB.plane(0).row(y), product.plane(0).row(y), maps.plane(0).row(y),
                            maps.plane(1).row(y), maps.width());
    });
    return maps;
}

double meanOfPlane(ConstFloatPlane plane) {
    double sum = 0;
    for (int y = 0; y < plane.height; ++y) {
        double row = 0;
        for (int x = 0; x < plane.width; ++x) row += plane.at(x, y);
        sum += row;
    }
    return sum / (static_cast<double>(plane.width) * plane.height);
}

Image halved(ConstFloatPlane in) {
    Image out({(in.width + 1) / 2, (in.height + 1) / 2}, 1);
    for (int y = 0; y < out.height(); ++y) {
        const float* top = in.row(2 * y);
        const float* bottom = in.row(std::min(2 * y + 1, in.height - 1));
        for (int x = 0; x < out.width(); ++x) {
            const int left = 2 * x, right = std::min(2 * x + 1, in.width - 1);
            out.at(0, x, y) = 0.25f * (top[left] + top[right] + bottom[left] + bottom[right]);
        }
    }
    return out;
}

Image channelOf(const Image& image, int c) {
    Image out(image.extent(), 1);
    std::copy_n(image.plane(c).data, out.size(), out.data());
    return out;
}

}  // namespace

double ssim(const Image& image, const Image& reference) {
    if (std::min(image.width(), image.height()) < kWindow) return std::nan("");
    double sum = 0;
    for (int c = 0; c < image.channels(); ++c) {
        const Image maps = ssimMaps(image.plane(c), reference.plane(c));
        sum += meanOfPlane(maps.plane(0));
    }
    return sum / image.channels();
}

double msSsim(const Image& image, const Image& reference) {
    constexpr std::array<double, 5> kWeights{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
    size_t scales = 0;
    for (int side = std::min(image.width(), image.height()); scales < kWeights.size() && side >= kWindow;
         side = (side + 1) / 2)
        ++scales;
    if (scales == 0) return std::nan("");
    double weightSum = 0;
    for (size_t i = 0; i < scales; ++i) weightSum += kWeights[i];

    double total = 0;
    for (int c = 0; c < image.channels(); ++c) {
        Image a = channelOf(image, c), b = channelOf(reference, c);
        double value = 1;
        for (size_t i = 0; i < scales; ++i) {
            const Image maps = ssimMaps(std::as_const(a).plane(0), std::as_const(b).plane(0));
            const double part = meanOfPlane(maps.plane(i + 1 < scales ? 1 : 0));
            value *= std::pow(std::max(0.0, part), kWeights[i] / weightSum);
            if (i + 1 < scales) {
                a = halved(std::as_const(a).plane(0));
                b = halved(std::as_const(b).plane(0));
            }
        }
        total += value;
    }
    return total / image.channels();
}

Measurement measureSsim(const ImagePair& pair, bool wantMap) {
    const Image a = ldrImage(pair.image, pair.exposureEv), b = ldrImage(pair.reference, pair.exposureEv);
    Measurement result;
    if (std::min(a.width(), a.height()) < kWindow) {
        result.value = std::nan("");
        return result;
    }
    // A window counts if its centre pixel does; the map shows 1 - SSIM at the centre, 0 in the border.
    constexpr int kBorder = kWindow / 2;
    Image map(a.extent(), 1);
    double sum = 0;
    int64_t count = 0;
    for (int c = 0; c < 3; ++c) {
        const Image maps = ssimMaps(a.plane(c), b.plane(c));
        for (int y = 0; y < maps.height(); ++y) {
            double row = 0;
            for (int x = 0; x < maps.width(); ++x) {
                if (!pair.counts(x + kBorder, y + kBorder)) continue;
                row += maps.at(0, x, y);
                ++count;
                map.at(0, x + kBorder, y + kBorder) += (1.0f - maps.at(0, x, y)) / 3.0f;
            }
            sum += row;
        }
    }
    result.value = count > 0 ? sum / static_cast<double>(count) : std::nan("");
    if (wantMap) result.map = std::move(map);
    return result;
}

Measurement measureMsSsim(const ImagePair& pair, bool) {
    Measurement result;
    result.value = msSsim(ldrImage(pair.image, pair.exposureEv), ldrImage(pair.reference, pair.exposureEv));
    return result;
}

}  // namespace lumi
