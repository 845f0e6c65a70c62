#include "measure/measure.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "measure/measure_kernels.h"

namespace lumi {
namespace {

bool finite(const Image& image, int x, int y) {
    return std::isfinite(image.at(0, x, y)) && std::isfinite(image.at(1, x, y)) && std::isfinite(image.at(2, x, y));
}

/// A pixel that is not finite in one of the two: see ImagePair::prepare().
void blank(Image& image, Image& reference, int x, int y, bool known) {
    for (int c = 0; c < 3; ++c) {
        if (!known) reference.at(c, x, y) = 0;
        image.at(c, x, y) = reference.at(c, x, y);
    }
}

}  // namespace

FlipExposures FlipExposures::over(double start, double stop) {
    return {start, stop, std::max(2, static_cast<int>(std::ceil(stop - start)))};
}

void ImagePair::prepare(const std::string& where) {
    const auto text = [](Extent2 e) { return fmt::format("{}x{}", e.width, e.height); };
    if (!(image.extent() == reference.extent()))
        throwBadInput({"images differ in size", where, text(reference.extent()), text(image.extent())});
    if (!mask.empty() && !(mask.extent() == image.extent()))
        throwBadInput({"the mask differs from the images in size", where, text(image.extent()), text(mask.extent())});
    const Extent2 extent = image.extent();
    Image counted(extent, 1);
    std::atomic<int64_t> brokenImage{0}, brokenReference{0}, broken{0}, left{0};
    parallelRanges(extent.height, 16, [&](int64_t begin, int64_t end) {
        int64_t imageHere = 0, referenceHere = 0, brokenHere = 0, leftHere = 0;
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < extent.width; ++x) {
                const bool seen = finite(image, x, y), known = finite(reference, x, y), good = seen && known;
                if (!good) blank(image, reference, x, y, known);
                const bool counts = good && (mask.empty() || mask.at(0, x, y) > 0.5f);
                counted.at(0, x, y) = counts ? 1.0f : 0.0f;
                imageHere += !seen;
                referenceHere += !known;
                brokenHere += !good;
                leftHere += !counts;
            }
        brokenImage += imageHere, brokenReference += referenceHere;
        broken += brokenHere, left += leftHere;
    });
    nonFiniteImage = brokenImage, nonFiniteReference = brokenReference, nonFinitePixels = broken;
    countedPixels = extent.area() - left;
    valid = left > 0 ? std::move(counted) : Image();
}

std::string ImagePair::whyNothingCounts() const {
    if (valid.empty() ? image.extent().area() > 0 : countedPixels > 0) return "";
    if (image.extent().area() == 0) return "the images have no pixels";
    if (nonFinitePixels == image.extent().area())
        return nonFiniteImage == nonFinitePixels       ? "no pixel of the image is finite"
               : nonFiniteReference == nonFinitePixels ? "no pixel of the reference is finite"
                                                       : "no pixel is finite in both images";
    return nonFinitePixels > 0 ? "no pixel in the mask is finite in both images" : "the mask leaves no pixel";
}

Image ldrImage(const Image& linear, float exposureEv) {
    Image out(linear.extent(), 3);
    const float factor = std::exp2(exposureEv);
    const MeasureKernels& kernels = measureKernels();
    parallelRanges(linear.height(), 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int c = 0; c < 3; ++c)
                kernels.encodeLdr(linear.plane(c).row(y), factor, out.plane(c).row(y), linear.width());
    });
    return out;
}

void clearUncounted(Image& map, const ImagePair& pair) {
    if (pair.valid.empty()) return;
    for (int y = 0; y < map.height(); ++y)
        for (int x = 0; x < map.width(); ++x)
            if (!pair.counts(x, y)) map.at(0, x, y) = 0;
}

double meanOverMask(const Image& map, const ImagePair& pair) {
    std::vector<double> sums(static_cast<size_t>(map.height()));
    std::vector<int64_t> counts(sums.size());
    parallelRanges(map.height(), 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y) {
            double row = 0;
            int64_t count = 0;
            for (int x = 0; x < map.width(); ++x)
                if (pair.counts(x, y)) {
                    row += map.at(0, x, y);
                    ++count;
                }
            sums[static_cast<size_t>(y)] = row, counts[static_cast<size_t>(y)] = count;
        }
    });
    double sum = 0;
    int64_t count = 0;
    for (size_t y = 0; y < sums.size(); ++y) sum += sums[y], count += counts[y];
    return count > 0 ? sum / static_cast<double>(count) : std::nan("");
}

Measurement meanMeasurement(Image map, const ImagePair& pair, bool wantMap) {
    Measurement result;
    result.value = meanOverMask(map, pair);
    result.reason = pair.whyNothingCounts();
    if (wantMap) {
        clearUncounted(map, pair);
        result.map = std::move(map);
    }
    return result;
}

}  // namespace lumi
