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
void blank(Image& image, Image& reference, int x, int y) {
    const bool known = finite(reference, x, y);
    for (int c = 0; c < 3; ++c) {
        if (!known) reference.at(c, x, y) = 0;
        image.at(c, x, y) = reference.at(c, x, y);
    }
}

}  // namespace

void ImagePair::prepare(const std::string& where) {
    const auto text = [](Extent2 e) { return fmt::format("{}x{}", e.width, e.height); };
    if (!(image.extent() == reference.extent()))
        throwBadInput({"images differ in size", where, text(reference.extent()), text(image.extent())});
    if (!mask.empty() && !(mask.extent() == image.extent()))
        throwBadInput({"the mask differs from the images in size", where, text(image.extent()), text(mask.extent())});
    const Extent2 extent = image.extent();
    Image counted(extent, 1);
    std::atomic<int64_t> broken{0}, left{0};
    parallelRanges(extent.height, 16, [&](int64_t begin, int64_t end) {
        int64_t brokenHere = 0, leftHere = 0;
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < extent.width; ++x) {
                const bool good = finite(image, x, y) && finite(reference, x, y);
                if (!good) blank(image, reference, x, y);
                const bool counts = good && (mask.empty() || mask.at(0, x, y) > 0.5f);
                counted.at(0, x, y) = counts ? 1.0f : 0.0f;
                brokenHere += !good;
                leftHere += !counts;
            }
        broken += brokenHere;
        left += leftHere;
    });
    nonFinitePixels = broken;
    valid = left > 0 ? std::move(counted) : Image();
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
    double sum = 0;
    int64_t count = 0;
    for (int y = 0; y < map.height(); ++y) {
        double row = 0;
        for (int x = 0; x < map.width(); ++x)
            if (pair.counts(x, y)) {
                row += map.at(0, x, y);
                ++count;
            }
        sum += row;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace lumi
