#include "filter/cross_bilateral.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr float kLog2E = 1.44269504f;
constexpr int64_t kRows = 8;

/// Variance of a pixel's colour over the pixels of its window that show a surface alike, mean of the channels.
float windowVariance(const Signals& signals, const Image& in, int radius, int x, int y) {
    const Image &normal = signals[Signal::Normal], &inverseDepth = signals[Signal::InverseDepth];
    const float z = inverseDepth.at(0, x, y);
    double sum[3] = {0, 0, 0}, squares[3] = {0, 0, 0};
    int count = 0;
    for (int j = std::max(y - radius, 0); j <= std::min(y + radius, in.height() - 1); ++j)
        for (int i = std::max(x - radius, 0); i <= std::min(x + radius, in.width() - 1); ++i) {
            float cosine = 0;
            for (int c = 0; c < 3; ++c) cosine += normal.at(c, x, y) * normal.at(c, i, j);
            if ((cosine < 0.9f || std::fabs(inverseDepth.at(0, i, j) - z) > 0.1f * z) && (i != x || j != y)) continue;
            ++count;
            for (int c = 0; c < 3; ++c) {
                const double v = in.at(c, i, j);
                sum[c] += v;
                squares[c] += v * v;
            }
        }
    double variance = 0;
    for (int c = 0; c < 3; ++c) variance += squares[c] / count - sum[c] * sum[c] / (double(count) * count);
    return static_cast<float>(std::max(variance / 3, 0.0));
}

CrossBilateralRow sharedRow(const Signals& signals, const Image& albedo, const SureSettings& settings,
                            const Image& in) {
    CrossBilateralRow row;
    row.width = in.width();
    row.height = in.height();
    row.filters = std::clamp(settings.filters, 1, CrossBilateralRow::kMost);
    const auto scale = [](float sigma) { return kLog2E / (2 * sigma * sigma); };
    for (int f = 0; f < row.filters; ++f) {
        row.spatialScale[f] = scale(static_cast<float>(1 << f));
        row.radius[f] = 2 << f;
    }
    for (int c = 0; c < 3; ++c) {
        row.rgb[c] = in.plane(c).data;
        row.normal[c] = signals[Signal::Normal].plane(c).data;
        row.albedo[c] = albedo.plane(c).data;
    }
    row.inverseDepth = signals[Signal::InverseDepth].data();
    row.normalScale = scale(settings.sigmaNormal);
    row.albedoScale = scale(settings.sigmaAlbedo);
    row.depthScale = scale(settings.sigmaDepth);
    return row;
}

bool runBank(const Signals& signals, const Image& albedo, const SureSettings& settings, const Image& in, SureBank& bank,
             std::stop_token stop) {
    const CrossBilateralRow shared = sharedRow(signals, albedo, settings, in);
    parallelRanges(
        in.height(), kRows,
        [&](int64_t begin, int64_t end) {
            CrossBilateralRow row = shared;
            std::vector<float> colourScale(static_cast<size_t>(row.width));
            for (row.y = static_cast<int>(begin); row.y < end; ++row.y) {
                for (int x = 0; x < row.width; ++x) {
                    const float variance = windowVariance(signals, in, settings.varianceRadius, x, row.y);
                    bank.variance.at(0, x, row.y) = variance;
                    colourScale[static_cast<size_t>(x)] =
                        kLog2E / (2 * settings.sigmaColour * settings.sigmaColour * variance + 1e-12f);
                }
                row.colourScale = colourScale.data();
                row.colourVariance = bank.variance.plane(0).row(row.y);
                for (int f = 0; f < row.filters; ++f) {
                    const auto at = static_cast<size_t>(f);
                    for (int c = 0; c < 3; ++c) row.out[f][c] = bank.filtered[at].plane(c).row(row.y);
                    row.error[f] = bank.error[at].plane(0).row(row.y);
                }
                crossBilateralKernels().filterRow(row);
            }
        },
        stop);
    return !stop.stop_requested();
}

/// Mean over the pixels of a window whose surfaces face alike.
float smoothed(const Signals& signals, const Image& in, int radius, int x, int y) {
    const Image& normal = signals[Signal::Normal];
    float sum = 0, weights = 0;
    for (int j = std::max(y - radius, 0); j <= std::min(y + radius, in.height() - 1); ++j)
        for (int i = std::max(x - radius, 0); i <= std::min(x + radius, in.width() - 1); ++i) {
            float cosine = 0;
            for (int c = 0; c < 3; ++c) cosine += normal.at(c, x, y) * normal.at(c, i, j);
            const float w = (i == x && j == y) || cosine > 0.9f ? 1.0f : 0.0f;
            sum += w * in.at(0, i, j);
            weights += w;
        }
    return sum / weights;
}

}  // namespace

size_t SureBank::bytes() const {
    size_t sum = variance.bytes() + choice.bytes() + scratch.bytes();
    for (const Image& image : filtered) sum += image.bytes();
    for (const Image& image : error) sum += image.bytes();
    return sum;
}

bool chooseBySure(const Signals& signals, const Image& albedo, const SureSettings& settings, const Image& in,
                  SureBank& bank, Image& out, std::stop_token stop) {
    const Extent2 extent = in.extent();
    if (bank.variance.extent() != extent) {
        for (Image* image : {&bank.variance, &bank.choice, &bank.scratch}) image->reset(extent, 1);
        for (Image& image : bank.filtered) image.reset(extent, 3);
        for (Image& image : bank.error) image.reset(extent, 1);
    }
    if (out.extent() != extent) out.reset(extent, 3);
    if (!runBank(signals, albedo, settings, in, bank, stop)) return false;
    const int filters = std::clamp(settings.filters, 1, CrossBilateralRow::kMost);
    for (auto f = static_cast<size_t>(filters); f < CrossBilateralRow::kMost; ++f) {
        bank.filtered[f].fill(0);
        bank.error[f].fill(0);
    }
    parallelRanges(
        extent.height, kRows,
        [&](int64_t begin, int64_t end) {
            for (int y = static_cast<int>(begin); y < end; ++y)
                for (int x = 0; x < extent.width; ++x) {
                    int best = 0;
                    float least = kInfinity;
                    for (int f = 0; f < filters; ++f) {
                        const float error = smoothed(signals, bank.error[static_cast<size_t>(f)], 2, x, y);
                        if (error < least) least = error, best = f;
                    }
                    bank.scratch.at(0, x, y) = static_cast<float>(best);
                }
        },
        stop);
    if (stop.stop_requested()) return false;
    parallelRanges(
        extent.height, kRows,
        [&](int64_t begin, int64_t end) {
            for (int y = static_cast<int>(begin); y < end; ++y)
                for (int x = 0; x < extent.width; ++x) {
                    const float choice = smoothed(signals, bank.scratch, 1, x, y);
                    bank.choice.at(0, x, y) = choice;
                    const int low = std::min(static_cast<int>(choice), filters - 1),
                              high = std::min(low + 1, filters - 1);
                    const float t = choice - static_cast<float>(low);
                    for (int c = 0; c < 3; ++c) {
                        const float a = bank.filtered[static_cast<size_t>(low)].at(c, x, y),
                                    b = bank.filtered[static_cast<size_t>(high)].at(c, x, y);
                        out.at(c, x, y) = a + t * (b - a);
                    }
                }
        },
        stop);
    return !stop.stop_requested();
}

}  // namespace lumi
