// SSIM [Wang 2004] and MS-SSIM [Wang 2003].
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "measure/metrics.h"
#include "measure/ssim_windows.h"

namespace lumi {
namespace {

constexpr const char* kTooSmall = "the images are smaller than a window of 11x11 pixels";
constexpr const char* kNoWindow = "no window of 11x11 pixels has a centre that counts";

int shortSide(const Image& image) { return std::min(image.width(), image.height()); }

double sumOf(const float* values, int count) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += values[i];
    return sum;
}

/// Does the centre of a window count? `counted` may be empty.
bool centreCounts(const Image& counted, int x, int y) {
    return counted.empty() || counted.at(0, x + kSsimBorder, y + kSsimBorder) >= 0.5f;
}

int64_t windowsThatCount(Extent2 extent, const Image& counted) {
    const int width = extent.width - kSsimWindow + 1, height = extent.height - kSsimWindow + 1;
    if (counted.empty()) return static_cast<int64_t>(width) * height;
    int64_t count = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) count += centreCounts(counted, x, y);
    return count;
}

/// Sum of the SSIM (or its contrast-structure part) over the windows that count; each is noted in `map` (may be null)
/// at its centre as a third of 1 - SSIM, added to what is there.
double sumThatCounts(const SsimPlanes& planes, const Image& counted, Image* map) {
    return sumOverWindows(planes, [&](const SsimSpan& span) {
        if (counted.empty() && !map) return sumOf(span.ssim, span.count);
        double sum = 0;
        for (int i = 0; i < span.count; ++i) {
            if (!centreCounts(counted, span.x + i, span.y)) continue;
            sum += span.ssim[i];
            if (map) map->at(0, span.x + i + kSsimBorder, span.y + kSsimBorder) += (1.0f - span.ssim[i]) / 3.0f;
        }
        return sum;
    });
}

Image halved(ConstFloatPlane in) {
    Image out({(in.width + 1) / 2, (in.height + 1) / 2}, 1);
    parallelRanges(out.height(), 32, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y) {
            const float* top = in.row(2 * y);
            const float* bottom = in.row(std::min(2 * y + 1, in.height - 1));
            for (int x = 0; x < out.width(); ++x) {
                const int left = 2 * x, right = std::min(2 * x + 1, in.width - 1);
                out.at(0, x, y) = 0.25f * (top[left] + top[right] + bottom[left] + bottom[right]);
            }
        }
    });
    return out;
}

Image channelOf(const Image& image, int c) {
    Image out(image.extent(), 1);
    std::copy_n(image.plane(c).data, out.size(), out.data());
    return out;
}

constexpr std::array<double, 5> kScaleWeights{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

size_t scalesThatFit(Extent2 extent) {
    size_t scales = 0;
    for (int side = std::min(extent.width, extent.height); scales < kScaleWeights.size() && side >= kSsimWindow;
         side = (side + 1) / 2)
        ++scales;
    return scales;
}

/// product *= max(part, 0)^weight, each pixel of full size taking the window around it at this scale.
void multiplyByScale(ConstFloatPlane part, size_t scale, double weight, Image& product) {
    parallelRanges(product.height(), 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < product.width(); ++x) {
                const int px = std::clamp((x >> scale) - kSsimBorder, 0, part.width - 1);
                const int py = std::clamp((y >> scale) - kSsimBorder, 0, part.height - 1);
                product.at(0, x, y) *= std::pow(std::max(part.at(px, py), 0.0f), static_cast<float>(weight));
            }
    });
}

/// Mean of one scale's part over the windows whose centre counts, NaN if none does; `part` (may be null) gets all
/// windows.
double meanOfScale(const SsimPlanes& planes, bool last, const Image& counted, Image* part) {
    const double sum = sumOverWindows(planes, [&](const SsimSpan& span) {
        const float* values = last ? span.ssim : span.contrast;
        if (part) std::copy_n(values, span.count, part->plane(0).row(span.y) + span.x);
        if (counted.empty()) return sumOf(values, span.count);
        double own = 0;
        for (int i = 0; i < span.count; ++i)
            if (centreCounts(counted, span.x + i, span.y)) own += values[i];
        return own;
    });
    const int64_t count = windowsThatCount({planes.a.width, planes.a.height}, counted);
    return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

/// MS-SSIM of one channel; `counted` says per pixel what counts (may be empty), `map` (may be null) gets the product of
/// the scales' local values.
double msSsimOfChannel(Image a, Image b, Image counted, Image* map) {
    const size_t scales = scalesThatFit(a.extent());
    double weightSum = 0, value = 1;
    for (size_t i = 0; i < scales; ++i) weightSum += kScaleWeights[i];
    if (map) map->fill(1);
    for (size_t i = 0; i < scales; ++i) {
        const bool last = i + 1 == scales;
        Image part;
        if (map) part.reset({a.width() - kSsimWindow + 1, a.height() - kSsimWindow + 1}, 1);
        const double weight = kScaleWeights[i] / weightSum;
        const double mean = meanOfScale({std::as_const(a).plane(0), std::as_const(b).plane(0), {}}, last, counted,
                                        map ? &part : nullptr);
        value *= std::isnan(mean) ? mean : std::pow(std::max(0.0, mean), weight);
        if (map) multiplyByScale(std::as_const(part).plane(0), i, weight, *map);
        if (last) break;
        a = halved(std::as_const(a).plane(0));
        b = halved(std::as_const(b).plane(0));
        if (!counted.empty()) counted = halved(std::as_const(counted).plane(0));
    }
    return value;
}

}  // namespace

double ssim(const Image& image, const Image& reference) {
    if (shortSide(image) < kSsimWindow) return std::nan("");
    double sum = 0;
    for (int c = 0; c < image.channels(); ++c)
        sum += sumThatCounts({image.plane(c), reference.plane(c), {}}, {}, nullptr);
    return sum / static_cast<double>(windowsThatCount(image.extent(), {}) * image.channels());
}

double msSsim(const Image& image, const Image& reference) {
    if (shortSide(image) < kSsimWindow) return std::nan("");
    double total = 0;
    for (int c = 0; c < image.channels(); ++c)
        total += msSsimOfChannel(channelOf(image, c), channelOf(reference, c), {}, nullptr);
    return total / image.channels();
}

Measurement measureSsim(const ImagePair& pair, bool wantMap) {
    Measurement result;
    if (wantMap) result.map.reset(pair.image.extent(), 1);
    if (shortSide(pair.image) < kSsimWindow) result.reason = kTooSmall;
    else if (result.reason = pair.whyNothingCounts();
             result.reason.empty() && windowsThatCount(pair.image.extent(), pair.valid) == 0)
        result.reason = kNoWindow;
    if (!result.reason.empty()) return result;
    // A window counts if its centre pixel does; the map shows 1 - SSIM at the centre, 0 in the border.
    const float factor = std::exp2(pair.exposureEv);
    double sum = 0;
    for (int c = 0; c < 3; ++c)
        sum += sumThatCounts({pair.image.plane(c), pair.reference.plane(c), factor}, pair.valid,
                             wantMap ? &result.map : nullptr);
    result.value = sum / static_cast<double>(3 * windowsThatCount(pair.image.extent(), pair.valid));
    return result;
}

Measurement measureMsSsim(const ImagePair& pair, bool wantMap) {
    Measurement result;
    if (wantMap) result.map.reset(pair.image.extent(), 1);
    if (shortSide(pair.image) < kSsimWindow) result.reason = kTooSmall;
    else result.reason = pair.whyNothingCounts();
    if (!result.reason.empty()) return result;
    const Image a = ldrImage(pair.image, pair.exposureEv), b = ldrImage(pair.reference, pair.exposureEv);
    Image product;
    if (wantMap) product.reset(a.extent(), 1);
    double total = 0;
    for (int c = 0; c < 3; ++c) {
        total += msSsimOfChannel(channelOf(a, c), channelOf(b, c), pair.valid, wantMap ? &product : nullptr);
        for (size_t i = 0; i < result.map.size(); ++i) result.map.data()[i] += (1 - product.data()[i]) / 3;
    }
    result.value = total / 3;
    if (std::isnan(result.value)) result.reason = kNoWindow;
    result.details.emplace_back("scales", static_cast<double>(scalesThatFit(a.extent())));
    if (wantMap) clearUncounted(result.map, pair);
    return result;
}

}  // namespace lumi
