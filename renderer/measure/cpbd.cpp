// Cumulative probability of blur detection [Narvekar & Karam 2011]: the share of edges whose blur is below what people
// just notice.
#include <algorithm>
#include <cmath>
#include <vector>

#include "math/vector.h"
#include "measure/metrics.h"

namespace lumi {
namespace {

constexpr int kBlock = 64;            // side of the blocks whose contrast sets the just noticeable blur
constexpr double kEdgeShare = 0.002;  // blocks with fewer edge pixels do not count
constexpr float kLeastSlope = 2;      // of an edge, grey levels a pixel
constexpr int kFarthest = 101;        // pixels on one side of an edge
constexpr double kBeta = 3.6;         // exponent of the psychometric function

/// Vertical edges: Sobel gradient along x of more than kLeastSlope, thinned along x, whose central differences point
/// along x within 22.5 degrees; of others the width along the row is not that of the edge.
std::vector<uint8_t> verticalEdges(ConstFloatPlane gray) {
    const int w = gray.width, h = gray.height;
    const auto at = [&](int x, int y) {
        return static_cast<size_t>(y) * static_cast<size_t>(w) + static_cast<size_t>(x);
    };
    std::vector<float> slope(static_cast<size_t>(w) * static_cast<size_t>(h), 0.0f);
    for (int y = 1; y + 1 < h; ++y)
        for (int x = 1; x + 1 < w; ++x)
            slope[at(x, y)] = std::abs(gray.at(x + 1, y - 1) + 2 * gray.at(x + 1, y) + gray.at(x + 1, y + 1) -
                                       gray.at(x - 1, y - 1) - 2 * gray.at(x - 1, y) - gray.at(x - 1, y + 1)) /
                              8;
    const float tangent = std::tan(radians(22.5f));
    std::vector<uint8_t> edges(slope.size(), 0);
    for (int y = 1; y + 1 < h; ++y)
        for (int x = 1; x + 1 < w; ++x) {
            const float alongX = std::abs(gray.at(x + 1, y) - gray.at(x - 1, y)),
                        alongY = std::abs(gray.at(x, y + 1) - gray.at(x, y - 1));
            const float here = slope[at(x, y)];
            edges[at(x, y)] = here > kLeastSlope && here > slope[at(x - 1, y)] && here >= slope[at(x + 1, y)] &&
                              (alongX == 0 || alongY < tangent * alongX);
        }
    return edges;
}

/// Pixels from the edge at `x` to the extremum on one side, along the row, at least one; `step` is -1 or 1, `rising`
/// the direction of the intensity towards that side.
int extent(const float* row, int width, int x, int step, bool rising) {
    int length = 1;
    for (int i = x + step; length < kFarthest && i + step >= 0 && i + step < width; i += step, ++length)
        if (rising ? row[i + step] <= row[i] : row[i + step] >= row[i]) break;
    return length;
}

/// Is blur of this probability not detected? The probability of a just noticeable blur, 1 - 1/e, is not: the authors'
/// program counts it in a histogram of whole percents, up to 63.
bool isSharp(double blurSeen) { return std::round(100 * blurSeen) <= 63; }

}  // namespace

double cpbd(ConstFloatPlane gray, const Image* counted, Image* map, int64_t* edgeCount) {
    const int w = gray.width, h = gray.height;
    if (map) map->reset({w, h}, 1);
    if (w < 3 || h < 3) return std::nan("");
    const std::vector<uint8_t> edges = verticalEdges(gray);
    int64_t total = 0, sharp = 0;
    for (int by = 0; by < h; by += kBlock)
        for (int bx = 0; bx < w; bx += kBlock) {
            const int x1 = std::min(bx + kBlock, w), y1 = std::min(by + kBlock, h);
            int count = 0;
            float low = 255, high = 0;
            for (int y = by; y < y1; ++y)
                for (int x = bx; x < x1; ++x) {
                    count += edges[static_cast<size_t>(y) * static_cast<size_t>(w) + static_cast<size_t>(x)];
                    low = std::min(low, gray.at(x, y)), high = std::max(high, gray.at(x, y));
                }
            if (count <= kEdgeShare * (x1 - bx) * (y1 - by)) continue;
            const double noticeable = high - low <= 50 ? 5 : 3;  // just noticeable blur in pixels (sec. III)
            for (int y = by; y < y1; ++y)
                for (int x = std::max(bx, 1); x < std::min(x1, w - 1); ++x) {
                    if (!edges[static_cast<size_t>(y) * static_cast<size_t>(w) + static_cast<size_t>(x)]) continue;
                    if (counted && !(counted->at(0, x, y) > 0.5f)) continue;
                    const float* row = gray.row(y);
                    const bool rising = row[x + 1] >= row[x - 1];
                    const int width = extent(row, w, x, 1, rising) + extent(row, w, x, -1, !rising);
                    const double blurSeen = 1 - std::exp(-std::pow(width / noticeable, kBeta));
                    if (map) map->at(0, x, y) = static_cast<float>(blurSeen);
                    ++total;
                    sharp += isSharp(blurSeen);
                }
        }
    if (edgeCount) *edgeCount = total;
    return total > 0 ? static_cast<double>(sharp) / static_cast<double>(total) : 0;
}

Measurement measureCpbd(const ImagePair& pair, bool wantMap) {
    const auto gray = [&](const Image& linear) {
        const Image ldr = ldrImage(linear, pair.exposureEv);
        Image out(ldr.extent(), 1);
        for (int y = 0; y < ldr.height(); ++y)
            for (int x = 0; x < ldr.width(); ++x)
                out.at(0, x, y) =
                    std::round(255 * (0.299f * ldr.at(0, x, y) + 0.587f * ldr.at(1, x, y) + 0.114f * ldr.at(2, x, y)));
        return out;
    };
    const Image image = gray(pair.image), reference = gray(pair.reference);
    Measurement result;
    const Image* counted = pair.valid.empty() ? nullptr : &pair.valid;
    int64_t edges = 0;
    result.value = cpbd(image.plane(0), counted, wantMap ? &result.map : nullptr, &edges);
    result.details = {{"edges", static_cast<double>(edges)}, {"reference_cpbd", cpbd(reference.plane(0), counted)}};
    result.reason = pair.whyNothingCounts();
    if (result.reason.empty() && std::isnan(result.value)) result.reason = "the image is smaller than 3x3 pixels";
    if (!result.reason.empty()) result.value = std::nan("");
    return result;
}

}  // namespace lumi
