#include "reconstruct/stable/stable_taps.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "reconstruct/stable/stable.h"

namespace lumi {
namespace {

constexpr int64_t kPixels = 1 << 14;

/// Fills a tap of one channel with a value a pixel.
template <class Value>
void fill(Image* out, Extent2 extent, Value value) {
    if (!out) return;
    out->reset(extent, 1);
    parallelRanges(extent.area(), kPixels, [&](int64_t begin, int64_t end) {
        for (int64_t pixel = begin; pixel < end; ++pixel) out->data()[pixel] = value(static_cast<size_t>(pixel));
    });
}

/// Mean of `value` over a pixel's visible samples; 0 without any.
template <class Value>
float meanOfVisible(const SampleFrame& frame, const SampleSet& samples, size_t pixel, Value value) {
    float sum = 0, count = 0;
    for (uint32_t i = samples.first[pixel]; i < samples.first[pixel + 1]; ++i) {
        if (frame.hidden[i]) continue;
        sum += static_cast<float>(value(samples.notes[i]));
        ++count;
    }
    return count > 0 ? sum / count : 0;
}

float verdictCode(const SampleFrame& frame, const SampleSet& samples, size_t pixel) {
    constexpr float kCodes[] = {2, 1, 3, 4, 5};  // by Verdict
    float code = 0;
    for (uint32_t i = samples.first[pixel]; i < samples.first[pixel + 1]; ++i)
        code = std::max(code, kCodes[static_cast<size_t>(frame.verdicts[i])]);
    return code;
}

/// Lanes of the packets that went to a pixel's samples.
float lanesOf(const SampleFrame& frame, const SampleSet& samples, VerificationSettings::Batches batches, size_t pixel) {
    // Bit k: the k-th sample of a pixel has a ray.
    const auto raysOf = [&](size_t p) {
        uint32_t rays = 0;
        for (uint32_t i = samples.first[p]; i < samples.first[p + 1]; ++i)
            rays |= frame.isVerified(i) ? 1u << (i - samples.first[p]) : 0;
        return rays;
    };
    if (batches == VerificationSettings::Batches::Dense) return static_cast<float>(std::popcount(raysOf(pixel)));
    const auto width = static_cast<size_t>(samples.extent.width);
    const size_t row = pixel / width * width, left = (pixel - row) / 16 * 16;
    uint32_t packets = 0;
    for (size_t x = left; x < std::min(left + 16, width); ++x) packets |= raysOf(row + x);
    return static_cast<float>(std::popcount(packets));
}

void drawChanges(const SampleFrame& frame, Extent2 extent, Image* out) {
    if (!out) return;
    out->reset(extent, 3);
    parallelRanges(extent.area(), kPixels, [&](int64_t begin, int64_t end) {
        for (int64_t pixel = begin; pixel < end; ++pixel) {
            const PixelChange& change = frame.changes[static_cast<size_t>(pixel)];
            out->plane(0).data[pixel] = static_cast<float>(subpixel::count(change.removed));
            out->plane(1).data[pixel] = static_cast<float>(subpixel::count(change.added));
        }
    });
}

/// The words as colours, and their two halves.
void drawBitmasks(const SampleSet& samples, Image* out) {
    if (!out) return;
    out->reset(samples.extent, 5);
    parallelRanges(samples.extent.area(), kPixels, [&](int64_t begin, int64_t end) {
        for (int64_t pixel = begin; pixel < end; ++pixel) {
            const uint32_t word = samples.words[static_cast<size_t>(pixel)];
            const uint32_t visible = subpixel::count(subpixel::visible(word)),
                           occluded = subpixel::count(subpixel::occluded(word));
            const float values[] = {0.25f * static_cast<float>(occluded), 0, 0.25f * static_cast<float>(visible),
                                    static_cast<float>(subpixel::occupied(word)),
                                    static_cast<float>(subpixel::occluded(word))};
            for (int c = 0; c < 5; ++c) out->plane(c).data[pixel] = values[c];
        }
    });
}

/// 1: no visible sample in the pixel; 2: nor in its 3x3 pixels.
float holeCode(const SampleSet& samples, size_t pixel) {
    if (subpixel::visible(samples.words[pixel])) return 0;
    const auto width = static_cast<size_t>(samples.extent.width), height = static_cast<size_t>(samples.extent.height);
    const size_t x = pixel % width, y = pixel / width;
    for (size_t v = y - std::min<size_t>(y, 1); v <= std::min(y + 1, height - 1); ++v)
        for (size_t u = x - std::min<size_t>(x, 1); u <= std::min(x + 1, width - 1); ++u)
            if (subpixel::visible(samples.words[v * width + u])) return 1;
    return 2;
}

}  // namespace

std::vector<Tap> stableTaps() {
    return {
        {.name = "subpixels",
         .channels = "RGB",
         .colourMap = "none",
         .help = "The 4x4 sub-pixels of the pixels around the middle, each drawn as a pixel: visible samples blue, "
                 "occluded red (fig. 6). Those of other pixels are seen in bitmasks, zoomed in"},
        {.name = "bitmasks",
         .channels = "RGBXY",
         .colourMap = "none",
         .help =
             "Visible samples as blue, occluded and just evicted ones as red, four of them as full colour; zoomed in, "
             "the window shows each pixel's 4x4 sub-pixels (fig. 6). X and Y are the occupancy and the occlusion bits"},
        {.name = "occupancy",
         .channels = "Y",
         .range = ValueRange{0, 65535},
         .help = "The 16 occupancy bits as a number; bit b is sub-pixel b, in rows from the top left"},
        {.name = "occlusion",
         .channels = "Y",
         .range = ValueRange{0, 65535},
         .help = "The 16 occlusion bits as a number; those of samples that were just evicted are set too"},
        {.name = "sampleCount",
         .channels = "Y",
         .unit = "samples",
         .range = ValueRange{0, 4},
         .help = "Visible samples in the pixel"},
        {.name = "density",
         .channels = "Y",
         .unit = "samples/px",
         .range = ValueRange{0, 4},
         .help = "Local density d after reprojection: visible samples in the 2x2 pixels around (sec. 4.2)"},
        {.name = "changes",
         .channels = "RGB",
         .colourMap = "none",
         .help = "Samples that the analysis added (green) and removed (red), as in fig. 4"},
        {.name = "age",
         .channels = "Y",
         .unit = "frames",
         .range = ValueRange{0, 64},
         .help = "Mean age of the pixel's visible samples"},
        {.name = "holes",
         .channels = "Y",
         .range = ValueRange{0, 2},
         .colourMap = "magma",
         .help = "1: no visible sample in the pixel; 2: nor in its 3x3 pixels. Where the filter has none in reach the "
                 "pixel is the mean of those around it"},
        {.name = "verdicts",
         .channels = "Y",
         .range = ValueRange{0, 5},
         .colourMap = "turbo",
         .help = "The worst verdict on the pixel's samples: 0 none, 1 visible, 2 new, 3 occluded, 4 moved to what "
                 "occludes it, 5 missed and evicted"},
        {.name = "indirectCount",
         .channels = "Y",
         .unit = "paths",
         .range = ValueRange{0, 16},
         .help = "Mean number of paths in the indirect light of the pixel's visible samples"},
        {.name = "lanes",
         .channels = "Y",
         .unit = "rays",
         .range = ValueRange{0, 8},
         .help = "Lanes of the packets of visibility rays that went to the pixel, idle ones included"},
        {.name = "sampleMotion",
         .channels = "XY",
         .unit = "px",
         .colourMap = "motion",
         .help = "The longest motion among the pixel's visible samples, previous minus current place"},
        {.name = "reconstructed",
         .channels = "RGB",
         .unit = "W/(m^2 sr)",
         .colourMap = "none",
         .help = "The image before temporal integration"}};
}

void drawSubpixels(const SampleSet& samples, Image& out) {
    const Vec3 kVisible(0.05f, 0.25f, 1), kOccluded(1, 0.05f, 0.05f), kEmpty[2] = {Vec3(0.02f), Vec3(0.06f)};
    const Extent2 extent = samples.extent;
    out.reset(extent, 3);
    const int left = extent.width / 2 - extent.width / (2 * subpixel::kSide);
    const int top = extent.height / 2 - extent.height / (2 * subpixel::kSide);
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x) {
            const Pixel p{left + x / subpixel::kSide, top + y / subpixel::kSide};
            const uint32_t word =
                samples.words[static_cast<size_t>(p.y) * static_cast<size_t>(extent.width) + static_cast<size_t>(p.x)];
            const uint32_t bit = subpixel::bit(y % subpixel::kSide * subpixel::kSide + x % subpixel::kSide);
            const Vec3 colour = subpixel::visible(word) & bit    ? kVisible
                                : subpixel::occupied(word) & bit ? kOccluded
                                                                 : kEmpty[(p.x + p.y) & 1];
            for (int c = 0; c < 3; ++c) out.at(c, x, y) = colour[c];
        }
}

void StableModule::keepTaps(const FrameContext& context, const SampleSet& samples) {
    if (context.wantedTaps.empty()) return;
    if (Image* out = taps_.target("subpixels")) drawSubpixels(samples, *out);
    drawBitmasks(samples, taps_.target("bitmasks"));
    fill(taps_.target("occupancy"), extent_,
         [&](size_t p) { return static_cast<float>(subpixel::occupied(samples.words[p])); });
    fill(taps_.target("occlusion"), extent_,
         [&](size_t p) { return static_cast<float>(subpixel::occluded(samples.words[p])); });
    fill(taps_.target("sampleCount"), extent_,
         [&](size_t p) { return static_cast<float>(std::popcount(subpixel::visible(samples.words[p]))); });
    taps_.keep("density", localDensity_);
    drawChanges(frame_, extent_, taps_.target("changes"));
    fill(taps_.target("age"), extent_,
         [&](size_t p) { return meanOfVisible(frame_, samples, p, [](const SampleNote& n) { return n.age; }); });
    fill(taps_.target("holes"), extent_, [&](size_t p) { return holeCode(samples, p); });
    fill(taps_.target("verdicts"), extent_, [&](size_t p) { return verdictCode(frame_, samples, p); });
    fill(taps_.target("indirectCount"), extent_, [&](size_t p) {
        return meanOfVisible(frame_, samples, p, [](const SampleNote& n) { return n.indirectCount; });
    });
    fill(taps_.target("lanes"), extent_, [&](size_t p) { return lanesOf(frame_, samples, verification_.batches, p); });
    taps_.keep("sampleMotion", motion_);
}

/// The samples that the image at a pixel is made of.
void StableModule::inspect(const FrameContext& context, const SampleSet& samples) {
    lineage_ = {};
    const auto& at = context.inspected;
    if (!at || at->x < 0 || at->y < 0 || at->x >= extent_.width || at->y >= extent_.height) return;
    lineage_.pixel = *at;
    float sum = 0;
    const Vec2 centre = Vec2(at->x, at->y) + 0.5f;
    for (int y = std::max(at->y - 1, 0); y <= std::min(at->y + 1, extent_.height - 1); ++y)
        for (int x = std::max(at->x - 1, 0); x <= std::min(at->x + 1, extent_.width - 1); ++x) {
            const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(extent_.width) + static_cast<size_t>(x);
            for (uint32_t i = samples.first[pixel]; i < samples.first[pixel + 1]; ++i) {
                const Vec2 off = samples.places[i] - centre;
                const float weight = frame_.hidden[i] ? 0 : scatteredWeight(scattered_, off, coloursOf(samples)[i]);
                sum += weight;
                const char* kNames[] = {"new", "visible", "occluded", "moved to what occludes it", "missed"};
                lineage_.rows.push_back({"reconstruction",
                                         {x, y},
                                         weight,
                                         std::string(kNames[static_cast<size_t>(frame_.verdicts[i])]) + ", age " +
                                             std::to_string(samples.notes[i].age)});
            }
        }
    for (Lineage::Row& row : lineage_.rows) row.weight = sum > 0 ? row.weight / sum : 0;
}

}  // namespace lumi
