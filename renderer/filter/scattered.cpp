#include "filter/scattered.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "filter/scattered_kernels.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 16;

/// The mean of a pixel's neighbours that have a colour; false if none has.
bool fillPixel(const Image& image, const std::vector<uint8_t>& known, int x, int y, Vec3& colour) {
    const Extent2 extent = image.extent();
    Vec3 sum(0);
    float count = 0;
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, extent.height - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, extent.width - 1); ++nx) {
            if (!known[static_cast<size_t>(ny) * static_cast<size_t>(extent.width) + static_cast<size_t>(nx)]) continue;
            for (int c = 0; c < 3; ++c) sum[c] += image.at(c, nx, ny);
            ++count;
        }
    colour = count > 0 ? sum / count : Vec3(0);
    return count > 0;
}

/// Holes around a pixel, each once.
void addNeighbours(Extent2 extent, uint32_t pixel, const std::vector<uint8_t>& known, std::vector<uint8_t>& listed,
                   std::vector<uint32_t>& ring) {
    const int x = static_cast<int>(pixel) % extent.width, y = static_cast<int>(pixel) / extent.width;
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, extent.height - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, extent.width - 1); ++nx) {
            const auto i = static_cast<size_t>(ny) * static_cast<size_t>(extent.width) + static_cast<size_t>(nx);
            if (known[i] || std::exchange(listed[i], uint8_t{1})) continue;
            ring.push_back(static_cast<uint32_t>(i));
        }
}

/// Gives a colour to pixels that no sample was near: ring after ring, each from what the one before left, so that the
/// work is that of the holes' number. Returns that number; -1 if stopped.
int64_t fillHoles(const Image& weights, Image& image, const std::stop_token& stop) {
    const Extent2 extent = image.extent();
    std::vector<uint8_t> known(weights.size());
    std::vector<uint32_t> ring;  // holes that may have a neighbour with a colour
    for (size_t i = 0; i < known.size(); ++i) {
        known[i] = weights.data()[i] > 0;
        if (!known[i]) ring.push_back(static_cast<uint32_t>(i));
    }
    const auto count = static_cast<int64_t>(ring.size());
    if (count == extent.area()) return count;
    std::vector<uint8_t> listed(known.size(), 0);
    std::vector<std::pair<uint32_t, Vec3>> filled;
    while (!ring.empty()) {
        if (stop.stop_requested()) return -1;
        filled.clear();
        for (const uint32_t hole : ring) {
            Vec3 colour;
            const int x = static_cast<int>(hole) % extent.width, y = static_cast<int>(hole) / extent.width;
            if (fillPixel(image, known, x, y, colour)) filled.emplace_back(hole, colour);
        }
        for (const auto& [hole, colour] : filled) {
            known[hole] = 1;
            for (int c = 0; c < 3; ++c) image.plane(c).data[hole] = colour[c];
        }
        ring.clear();
        for (const auto& [hole, colour] : filled) addNeighbours(extent, hole, known, listed, ring);
    }
    return count;
}

}  // namespace

void ScatteredSettings::describe(ParameterVisitor& v, bool onePerPixel) {
    v.choice(
        "filter", filter,
        {.label = "Reconstruction filter",
         .options = {"gaussian", "box"},
         .help =
             "What makes pixels of samples: a Gaussian over 3x3 pixels (sec. 4.4), or the mean of the pixel's own"});
    v.when(filter == Filter::Gaussian, [&] {
        v.number(
            "sigma", sigma,
            {.label = "Filter width",
             .min = 0.1,
             .max = 2,
             .scale = Scale::Log,
             .unit = "px",
             .help =
                 "Standard deviation of the Gaussian, which is cut off after 3x3 pixels (sec. 4.4 does not give it)"});
    });
    v.when(!onePerPixel || filter == Filter::Gaussian, [&] {
        v.toggle(
            "tone-mapped", toneMapped,
            {.label = "Filter tone-mapped",
             .help =
                 "Compress colours by c / (1 + luminance) before the filter and expand them after it (sec. 5 stores "
                 "tone-mapped colours); off: the filter is linear"});
    });
}

float scatteredWeight(const ScatteredSettings& settings, Vec2 off, const Vec3& colour) {
    if (!std::isfinite(colour.x) || !std::isfinite(colour.y) || !std::isfinite(colour.z)) return 0;
    const float tone = settings.toneMapped ? 1 / (1 + std::max(luminance(colour), 0.0f)) : 1;
    const bool inPixel = off.x >= -0.5f && off.x < 0.5f && off.y >= -0.5f && off.y < 0.5f;
    if (settings.filter == ScatteredSettings::Filter::Box) return inPixel ? tone : 0;
    return tone * std::exp(-glm::dot(off, off) / (2 * settings.sigma * settings.sigma));
}

int64_t reconstructScattered(const ScatteredSamples& samples, const ScatteredSettings& settings, Image& out,
                             Image& weights, std::stop_token stop) {
    const Extent2 extent = samples.extent;
    if (out.extent() != extent || out.channels() != 3) out.reset(extent, 3);
    if (weights.extent() != extent) weights.reset(extent, 1);
    ScatteredRows shared;
    shared.width = extent.width, shared.height = extent.height;
    shared.first = samples.first.data();
    shared.places = samples.places.empty() ? nullptr : &samples.places[0].x;
    shared.colours = samples.colours.empty() ? nullptr : &samples.colours[0].x;
    shared.hidden = samples.hidden.empty() ? nullptr : samples.hidden.data();
    shared.box = settings.filter == ScatteredSettings::Filter::Box;
    shared.toneMapped = settings.toneMapped;
    shared.falloff = 1 / (2 * settings.sigma * settings.sigma);
    std::atomic<bool> hasHoles{false};
    parallelRanges(
        extent.height, kRows,
        [&](int64_t begin, int64_t end) {
            const size_t stride = 4 * (static_cast<size_t>(extent.width) + 2);
            std::vector<float> sums(stride * static_cast<size_t>(end - begin), 0.0f);
            ScatteredRows rows = shared;
            rows.top = static_cast<int>(begin), rows.bottom = static_cast<int>(end);
            rows.sums = sums.data();
            scatteredKernels().splat(rows);
            for (int y = rows.top; y < rows.bottom; ++y) {
                float* const planes[3] = {out.plane(0).row(y), out.plane(1).row(y), out.plane(2).row(y)};
                scatteredKernels().resolve(sums.data() + stride * static_cast<size_t>(y - rows.top), extent.width,
                                           planes, weights.plane(0).row(y));
                const float* line = weights.plane(0).row(y);
                if (std::any_of(line, line + extent.width, [](float w) { return !(w > 0); })) hasHoles = true;
            }
        },
        stop);
    if (stop.stop_requested()) return -1;
    return hasHoles ? fillHoles(weights, out, stop) : 0;
}

}  // namespace lumi
