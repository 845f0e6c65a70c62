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

constexpr int kWindow = 11, kBorder = kWindow / 2;

/// Horizontally smoothed rows of a, b, a*a, b*b, a*b: a ring of the window's height for each.
class SmoothedRows {
public:
    SmoothedRows(ConstFloatPlane a, ConstFloatPlane b)
        : a_(a), b_(b), product_(static_cast<size_t>(a.width)), ring_({a.width - kWindow + 1, kWindow}, 5) {}

    void add(int y) {
        const MeasureKernels& kernels = measureKernels();
        const float *rowA = a_.row(y), *rowB = b_.row(y);
        const auto smooth = [&](const float* row, int quantity) {
            kernels.convolveRow(row, weights_.data(), kWindow, ring_.plane(quantity).row(y % kWindow), ring_.width());
        };
        const auto smoothProduct = [&](const float* p, const float* q, int quantity) {
            for (int x = 0; x < a_.width; ++x) product_[static_cast<size_t>(x)] = p[x] * q[x];
            smooth(product_.data(), quantity);
        };
        smooth(rowA, 0);
        smooth(rowB, 1);
        smoothProduct(rowA, rowA, 2);
        smoothProduct(rowB, rowB, 3);
        smoothProduct(rowA, rowB, 4);
    }
    /// Window sums of the rows [y, y + kWindow), all added before.
    void window(int y, int quantity, float* out) const {
        const float* rows[kWindow];
        for (int k = 0; k < kWindow; ++k) rows[k] = ring_.plane(quantity).row((y + k) % kWindow);
        measureKernels().convolveColumn(rows, weights_.data(), kWindow, out, ring_.width());
    }

private:
    ConstFloatPlane a_, b_;
    std::vector<float> weights_ = gaussianWeights(kWindow, 1.5), product_;
    Image ring_;
};

/// SSIM and its contrast-structure part at every window that lies inside; two channels.
Image ssimMaps(ConstFloatPlane a, ConstFloatPlane b) {
    Image maps({a.width - kWindow + 1, a.height - kWindow + 1}, 2);
    parallelRanges(maps.height(), 64, [&](int64_t begin, int64_t end) {
        const int first = static_cast<int>(begin);
        SmoothedRows rows(a, b);
        Image sums({maps.width(), 5}, 1);
        for (int y = first; y < first + kWindow - 1; ++y) rows.add(y);
        for (int y = first; y < end; ++y) {
            rows.add(y + kWindow - 1);
            float* s[5];
            for (int q = 0; q < 5; ++q) rows.window(y, q, s[q] = sums.plane(0).row(q));
            measureKernels().ssimRow(s[0], s[1], s[2], s[3], s[4], maps.plane(0).row(y), maps.plane(1).row(y),
                                     maps.width());
        }
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

namespace {

constexpr std::array<double, 5> kScaleWeights{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

size_t scalesThatFit(Extent2 extent) {
    size_t scales = 0;
    for (int side = std::min(extent.width, extent.height); scales < kScaleWeights.size() && side >= kWindow;
         side = (side + 1) / 2)
        ++scales;
    return scales;
}

/// Mean over the windows whose centre counts; `counted` may be empty. NaN if none does.
double meanOfWindows(ConstFloatPlane plane, const Image& counted) {
    if (counted.empty()) return meanOfPlane(plane);
    double sum = 0;
    int64_t count = 0;
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x) {
            if (!(counted.at(0, x + kBorder, y + kBorder) >= 0.5f)) continue;
            sum += plane.at(x, y);
            ++count;
        }
    return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

/// product *= max(part, 0)^weight, each pixel of full size taking the window around it at this scale.
void multiplyByScale(ConstFloatPlane part, size_t scale, double weight, Image& product) {
    parallelRanges(product.height(), 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < product.width(); ++x) {
                const int px = std::clamp((x >> scale) - kBorder, 0, part.width - 1);
                const int py = std::clamp((y >> scale) - kBorder, 0, part.height - 1);
                product.at(0, x, y) *= std::pow(std::max(part.at(px, py), 0.0f), static_cast<float>(weight));
            }
    });
}

/// MS-SSIM of one channel; `counted` says per pixel what counts (may be empty), `map` (may be null) gets the product of
/// the scales' local values.
double msSsimOfChannel(Image a, Image b, Image counted, Image* map) {
    const size_t scales = scalesThatFit(a.extent());
    double weightSum = 0, value = 1;
    for (size_t i = 0; i < scales; ++i) weightSum += kScaleWeights[i];
    if (map) map->fill(1);
    for (size_t i = 0; i < scales; ++i) {
        const Image maps = ssimMaps(std::as_const(a).plane(0), std::as_const(b).plane(0));
        const ConstFloatPlane part = maps.plane(i + 1 < scales ? 1 : 0);
        const double weight = kScaleWeights[i] / weightSum;
        const double mean = meanOfWindows(part, counted);
        value *= std::isnan(mean) ? mean : std::pow(std::max(0.0, mean), weight);
        if (map) multiplyByScale(part, i, weight, *map);
        if (i + 1 == scales) break;
        a = halved(std::as_const(a).plane(0));
        b = halved(std::as_const(b).plane(0));
        if (!counted.empty()) counted = halved(std::as_const(counted).plane(0));
    }
    return value;
}

}  // namespace

double msSsim(const Image& image, const Image& reference) {
    if (scalesThatFit(image.extent()) == 0) return std::nan("");
    double total = 0;
    for (int c = 0; c < image.channels(); ++c) total += msSsimOfChannel(channelOf(image, c), channelOf(reference, c), {}, nullptr);
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

Measurement measureMsSsim(const ImagePair& pair, bool wantMap) {
    const Image a = ldrImage(pair.image, pair.exposureEv), b = ldrImage(pair.reference, pair.exposureEv);
    Measurement result;
    if (wantMap) result.map.reset(a.extent(), 1);
    if (scalesThatFit(a.extent()) == 0) {
        result.value = std::nan("");
        return result;
    }
    Image product(a.extent(), 1);
    for (int c = 0; c < 3; ++c) {
        result.value += msSsimOfChannel(channelOf(a, c), channelOf(b, c), pair.valid, wantMap ? &product : nullptr);
        for (size_t i = 0; i < result.map.size(); ++i) result.map.data()[i] += (1 - product.data()[i]) / 3;
    }
    result.value /= 3;
    if (wantMap) clearUncounted(result.map, pair);
    return result;
}

}  // namespace lumi
